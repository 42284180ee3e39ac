"""Experiments: policies × friction knowledge × materials, with figures and confidence intervals."""

from policies.evaluation.experiment import Experiment
from policies.evaluation.plan import experiment_names, load_experiment, narrowed
from policies.evaluation.run import evaluate
from policies.evaluation.tables import report
from policies.evaluation.trial import check

__all__ = ["Experiment", "check", "evaluate", "experiment_names", "load_experiment", "narrowed", "report"]
