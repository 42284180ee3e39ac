"""The command `slipgym ship`."""

from policies.commands.ship import app
from policies.console import spell_out

if __name__ == "__main__":
    spell_out()
    app()
