"""The command `slipgym rank`."""

import sys

from policies.commands.front import main

if __name__ == "__main__":
    main(["rank", *sys.argv[1:]])
