"""The command `slipgym policy-leaderboard`."""

import sys

from policies.commands.front import main

if __name__ == "__main__":
    main(["policy-leaderboard", *sys.argv[1:]])
