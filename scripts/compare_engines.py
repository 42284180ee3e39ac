"""The command `slipgym compare-engines`."""

from policies.commands.compare_engines import app

if __name__ == "__main__":
    app()
