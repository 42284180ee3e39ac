"""Fixtures of other tests that those of a study's report use, too."""

from tests.policies.study.conftest import invented, nothing, small
from tests.scripts.conftest import invoke

__all__ = ["invented", "invoke", "nothing", "small"]
