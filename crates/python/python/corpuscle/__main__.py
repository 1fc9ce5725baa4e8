"""`python -m corpuscle` is the command `corpuscle`."""

import sys

from ._command import main

sys.exit(main())
