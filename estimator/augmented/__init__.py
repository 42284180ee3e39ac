"""Parts of the "adaptive" estimator: the law of slip, the filter, the delay, static friction, deviations."""
