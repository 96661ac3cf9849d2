"""python3 -m train.tune: see sinew-train --help."""
import sys

from .program import main

sys.exit(main())
