"""Figures of a study."""

from policies.study.figures.degradation import plot_degradation
from policies.study.figures.differences import plot_shares, plot_transfer
from policies.study.figures.success import plot_estimators, plot_success

__all__ = ["plot_degradation", "plot_estimators", "plot_shares", "plot_success", "plot_transfer"]
