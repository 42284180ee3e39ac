"""The command `slipgym compare-learned`."""

import sys

from policies.commands.front import main

if __name__ == "__main__":
    main(["compare-learned", *sys.argv[1:]])
