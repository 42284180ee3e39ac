"""The configuration of the environments: typed, frozen, validated, with its defaults in configs/."""

from slipgym.config.hardware import GripperConfig, ObjectConfig
from slipgym.config.load import Overrides, load, load_randomization, names
from slipgym.config.physics import ContactConfig, Material, NominalConfig, PhysicsConfig
from slipgym.config.randomization import Randomization, Ranges
from slipgym.config.root import Config
from slipgym.config.sensors import ForceTorqueConfig, SensorsConfig, SlipConfig
from slipgym.config.tasks import (
    HingeConfig,
    HoldConfig,
    LinearSlipConfig,
    PlanarSlipConfig,
    RotationalSlipConfig,
    TaskConfig,
    TasksConfig,
)

__all__ = [
    "Config",
    "ContactConfig",
    "ForceTorqueConfig",
    "GripperConfig",
    "HingeConfig",
    "HoldConfig",
    "LinearSlipConfig",
    "Material",
    "NominalConfig",
    "ObjectConfig",
    "Overrides",
    "PhysicsConfig",
    "PlanarSlipConfig",
    "Randomization",
    "Ranges",
    "RotationalSlipConfig",
    "SensorsConfig",
    "SlipConfig",
    "TaskConfig",
    "TasksConfig",
    "load",
    "load_randomization",
    "names",
]
