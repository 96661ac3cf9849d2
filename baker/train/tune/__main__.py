"""python3 baker/train/tune ...: sinew-train; see its --help."""
import sys
from pathlib import Path

if not __package__:
    sys.path[0] = str(Path(__file__).resolve().parents[2])

from train.tune.program import main  # noqa: E402

sys.exit(main())
