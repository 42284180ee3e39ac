"""The command `slipgym train`."""

import sys

from policies.commands.front import main

if __name__ == "__main__":
    main(["train", *sys.argv[1:]])
