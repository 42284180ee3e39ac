"""The command `slipgym compare-learned`."""

from policies.commands.compare_learned import app
from policies.console import spell_out

if __name__ == "__main__":
    spell_out()
    app()
