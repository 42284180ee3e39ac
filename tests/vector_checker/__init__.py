"""Checks a vector environment against Gymnasium's conventions, as `check_env` checks a single one."""

from tests.vector_checker.check import check_vector_env

__all__ = ["check_vector_env"]
