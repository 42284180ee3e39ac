"""The command `slipgym compare-engines`."""

import sys

from policies.commands.front import main

if __name__ == "__main__":
    main(["compare-engines", *sys.argv[1:]])
