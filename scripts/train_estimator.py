"""The command `slipgym train-estimator`."""

import sys

from policies.commands.front import main

if __name__ == "__main__":
    main(["train-estimator", *sys.argv[1:]])
