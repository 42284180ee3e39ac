"""The command `slipgym ship`."""

import sys

from policies.commands.front import main

if __name__ == "__main__":
    main(["ship", *sys.argv[1:]])
