"""The command `slipgym validate`."""

import sys

from policies.commands.front import main

if __name__ == "__main__":
    main(["validate", *sys.argv[1:]])
