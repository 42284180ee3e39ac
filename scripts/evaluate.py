"""The command `slipgym evaluate`."""

import sys

from policies.commands.front import main

if __name__ == "__main__":
    main(["evaluate", *sys.argv[1:]])
