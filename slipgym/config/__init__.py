"""The configuration of the environments: typed, frozen, validated, with its defaults in configs/."""

from slipgym.config.hardware import GripperConfig, ObjectConfig
from slipgym.config.load import Overrides, load, load_randomization, names
from slipgym.config.physics import ContactConfig, Material, NominalConfig, PhysicsConfig
from slipgym.config.randomization import Randomization, Ranges
from slipgym.config.root import Config
from slipgym.config.sensors import ForceTorqueConfig, SensorsConfig, SlipConfig
from slipgym.config.task import TaskConfig

__all__ = [
    "Config",
    "ContactConfig",
    "ForceTorqueConfig",
    "GripperConfig",
    "Material",
    "NominalConfig",
    "ObjectConfig",
    "Overrides",
    "PhysicsConfig",
    "Randomization",
    "Ranges",
    "SensorsConfig",
    "SlipConfig",
    "TaskConfig",
    "load",
    "load_randomization",
    "names",
]
