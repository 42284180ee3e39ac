"""The command `slipgym imitate`."""

from policies.commands.imitate import app
from policies.console import spell_out

if __name__ == "__main__":
    spell_out()
    app()
