"""The command `slipgym record`."""

from policies.commands.record import app
from policies.console import spell_out

if __name__ == "__main__":
    spell_out()
    app()
