"""The benefit of knowing friction: policies x friction information, on both engines."""

from policies.study.config import Study, load_study, narrowed, study_names
from policies.study.run import run_study
from policies.study.terminal import words

__all__ = ["Study", "load_study", "narrowed", "run_study", "study_names", "words"]
