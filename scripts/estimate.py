"""The command `slipgym estimate`."""

import sys

from policies.commands.front import main

if __name__ == "__main__":
    main(["estimate", *sys.argv[1:]])
