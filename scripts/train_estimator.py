"""The command `slipgym train-estimator`."""

from policies.commands.train_estimator import app

if __name__ == "__main__":
    app()
