#!/usr/bin/python3
"""Makes a load report of results of inverse_dynamics_offline, or one of many; see --help."""
import os
import sys

# Beside this file, also where it is a link; modules of this package only.
sys.path.insert(0, os.path.dirname(os.path.realpath(__file__)))

from vwd_loads.command import main  # noqa: E402

if __name__ == '__main__':
    sys.exit(main(sys.argv[1:]))
