"""Fixtures of the policies' tests that the laboratory's use, too."""

from tests.policies.conftest import play_batch, small

__all__ = ["play_batch", "small"]
