"""The command `slipgym play`."""

import sys

from policies.commands.front import main

if __name__ == "__main__":
    main(["play", *sys.argv[1:]])
