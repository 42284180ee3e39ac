"""Merges the estimates of both fingers, each weighted by its confidence."""

from slipgym._numba.compiled import compiled


@compiled
def weighted_mean(a, b, weight_a, weight_b):
    """Mean of two values by their weights; the plain mean if both weights are 0."""
    total = weight_a + weight_b
    return (a * weight_a + b * weight_b) / total if total > 0.0 else 0.5 * (a + b)


@compiled
def mean_mu_s(first, second):
    """mu_s of both fingers, weighted by confidence."""
    return weighted_mean(first.mu_s, second.mu_s, first.confidence_mu_s, second.confidence_mu_s)


@compiled
def merged_mu_c(first, second):
    """mu_c of both fingers; as in `estimator.sample.publish`, a start value yields to a measured mu_s."""
    mu_c = weighted_mean(first.mu_c, second.mu_c, first.confidence_mu_c, second.confidence_mu_c)
    if first.confidence_mu_c + second.confidence_mu_c > 0.0:
        return mu_c
    if first.confidence_mu_s + second.confidence_mu_s > 0.0:
        return min(mu_c, mean_mu_s(first, second))
    return mu_c


@compiled
def merged_mu_s(first, second):
    """mu_s of both fingers, at least their mu_c: the weights differ, so that the means may cross."""
    return max(mean_mu_s(first, second), merged_mu_c(first, second))
