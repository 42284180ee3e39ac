"""The command `slipgym train-estimator`."""

from policies.commands.train_estimator import app
from policies.console import spell_out

if __name__ == "__main__":
    spell_out()
    app()
