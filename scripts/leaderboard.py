"""The command `slipgym leaderboard`."""

import sys

from policies.commands.front import main

if __name__ == "__main__":
    main(["leaderboard", *sys.argv[1:]])
