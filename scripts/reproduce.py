"""The command `slipgym reproduce`."""

import sys

from policies.commands.front import main

if __name__ == "__main__":
    main(["reproduce", *sys.argv[1:]])
