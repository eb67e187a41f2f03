"""``python -m mcgw``."""

import sys

from mcgw.cli import main

sys.exit(main())
