"""The bench of the validation sees what it is to see."""

from slipgym.validation.bench import Bench


def test_it_watches_the_engine_s_pose_after_every_step():
    with Bench(force=5.0) as bench:
        bench.settle()
        bench.world.mismatch = -1.0  # a distance replaces it
        bench.run(0.02)
        assert 0.0 <= bench.mismatch <= 1e-9
