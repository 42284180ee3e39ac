"""The command `slipgym pushes`."""

import sys

from policies.commands.front import main

if __name__ == "__main__":
    main(["pushes", *sys.argv[1:]])
