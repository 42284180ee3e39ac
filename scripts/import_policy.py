"""The command `slipgym import-policy`."""

import sys

from policies.commands.front import main

if __name__ == "__main__":
    main(["import-policy", *sys.argv[1:]])
