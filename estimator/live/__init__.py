"""Estimates friction while a gripper runs, from readings that come late, twice, out of order or not at all.

    from estimator.live import Live

    live = Live("adaptive", r_max=0.015)
    for output in live.feed_wrench(1, stamp, wrench) + live.feed_twist(1, stamp, twist):
        output.estimate.mu_c, output.estimate.sd_mu_c, output.status

Nothing here opens a port; `estimator.live.udp` and `.ros` do.
"""

from estimator.live.hand import Output
from estimator.live.live import Live
from estimator.live.log import Log, read, records

__all__ = ["Live", "Log", "Output", "read", "records"]
