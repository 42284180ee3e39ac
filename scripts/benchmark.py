"""The command `slipgym benchmark`."""

import sys

from policies.commands.front import main

if __name__ == "__main__":
    main(["benchmark", *sys.argv[1:]])
