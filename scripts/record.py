"""The command `slipgym record`."""

import sys

from policies.commands.front import main

if __name__ == "__main__":
    main(["record", *sys.argv[1:]])
