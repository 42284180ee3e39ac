"""The command `slipgym evaluate`."""

from policies.commands.evaluate import app
from policies.console import spell_out

if __name__ == "__main__":
    spell_out()
    app()
