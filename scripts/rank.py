"""The command `slipgym rank`."""

from policies.commands.rank import app
from policies.console import spell_out

if __name__ == "__main__":
    spell_out()
    app()
