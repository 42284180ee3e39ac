"""The small configuration of the training's tests."""

from tests.policies.training.conftest import small

__all__ = ["small"]
