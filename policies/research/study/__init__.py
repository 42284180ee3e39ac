"""The benefit of knowing friction: policies x friction information, on both engines."""

from policies.research.study.config import Study
from policies.research.study.files import load_study, narrowed, study_names
from policies.research.study.run import run_study
from policies.research.study.terminal import words

__all__ = ["Study", "load_study", "narrowed", "run_study", "study_names", "words"]
