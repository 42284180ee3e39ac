"""The command `slipgym compare-learned`."""

from policies.commands.compare_learned import app

if __name__ == "__main__":
    app()
