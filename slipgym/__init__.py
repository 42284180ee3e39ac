"""Gymnasium environments for slip-aware in-hand manipulation, with a friction estimator in the loop."""

from slipgym.registration import register, register_task

__all__ = ["register_task"]

register()
