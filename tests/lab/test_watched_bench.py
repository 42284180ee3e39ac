"""The bench of the engines' agreement sees what it is to see."""

from lab.validation.agreement import WatchedBench


def test_it_watches_the_engine_s_pose_after_every_step():
    with WatchedBench(force=5.0) as bench:
        bench.settle()
        bench.world.mismatch = -1.0  # a distance replaces it
        bench.run(0.02)
        assert 0.0 <= bench.mismatch <= 1e-9
