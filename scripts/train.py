"""The command `slipgym train`."""

from policies.commands.train import app
from policies.console import spell_out

if __name__ == "__main__":
    spell_out()
    app()
