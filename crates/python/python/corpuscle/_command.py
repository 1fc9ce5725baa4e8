"""The command `corpuscle`, as the package installs it."""

import sys

from . import _native


def main() -> int:
    """Runs the command line on the arguments of this process; returns the exit status."""
    return _native.run_command_line(["corpuscle", *sys.argv[1:]])
