"""The command `slipgym compare-engines`."""

from policies.commands.compare_engines import app
from policies.console import spell_out

if __name__ == "__main__":
    spell_out()
    app()
