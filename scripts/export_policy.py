"""The command `slipgym export-policy`."""

import sys

from policies.commands.front import main

if __name__ == "__main__":
    main(["export-policy", *sys.argv[1:]])
