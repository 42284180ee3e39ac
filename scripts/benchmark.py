"""The command `slipgym benchmark`."""

from policies.commands.benchmark import app
from policies.console import spell_out

if __name__ == "__main__":
    spell_out()
    app()
