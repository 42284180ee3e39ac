"""The command `slipgym imitate`."""

import sys

from policies.commands.front import main

if __name__ == "__main__":
    main(["imitate", *sys.argv[1:]])
