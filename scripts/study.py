"""The command `slipgym study`."""

import sys

from policies.commands.front import main

if __name__ == "__main__":
    main(["study", *sys.argv[1:]])
