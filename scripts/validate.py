"""The command `slipgym validate`."""

from policies.commands.validate import app
from policies.console import spell_out

if __name__ == "__main__":
    spell_out()
    app()
