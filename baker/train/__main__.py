"""python3 baker/train COMMAND ...: see --help."""
import sys
from pathlib import Path

if not __package__:
    sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

from train.cli import main  # noqa: E402

sys.exit(main())
