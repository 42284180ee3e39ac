import pytest


@pytest.fixture(scope="session")
def small():
    """Makes configurations of runs of seconds: short episodes without randomization."""
    pytest.importorskip("stable_baselines3")
    from policies.training.files import checked

    def make(**changes):
        values = {
            "task": "LinearSlip",
            "budget": 96,
            "num_envs": 2,
            "environment": {
                "randomization": "none",
                "frame_skip": 4,
                "config": {"tasks": {"linear_slip": {"duration": 0.2, "settle": 0.1, "hold": 0.1}}},
            },
            "evaluation": {"every": 32, "episodes": 2},
            "checkpoints": {"every": 32},
            "ppo": {"n_steps": 16, "batch_size": 16, "n_epochs": 1},
            "recurrent_ppo": {"n_steps": 16, "batch_size": 16, "n_epochs": 1, "lstm_hidden_size": 8},
            "privileged_ppo": {"n_steps": 16, "n_epochs": 1, "n_minibatches": 1},
            "sac": {"buffer_size": 80, "learning_starts": 40, "batch_size": 16},
            "tqc": {"buffer_size": 80, "learning_starts": 40, "batch_size": 16},
        }
        return checked({**values, **changes}, "test")

    return make
