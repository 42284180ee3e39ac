"""The command `slipgym estimate`."""

from policies.commands.estimate import app
from policies.console import spell_out

if __name__ == "__main__":
    spell_out()
    app()
