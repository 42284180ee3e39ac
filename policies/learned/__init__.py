"""Learned policies as files that execute nothing when they are loaded; see docs/policy_files.md.

`policies.learned.export` writes them from Stable-Baselines3's models and rebuilds those for more training;
`policies.learned.onnx_graph` writes them for a controller on a robot.
"""

from policies.learned.description import Description
from policies.learned.files import read_description
from policies.learned.policy import LearnedPolicy

__all__ = ["Description", "LearnedPolicy", "read_description"]
