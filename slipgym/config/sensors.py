"""Configuration models of the sensors: those of each finger, of a wrist, a gripper's motor, and markers."""

from typing import Annotated, Literal, Self

from pydantic import Field, model_validator

from slipgym.config.base import Frozen, number

Probability = Annotated[float, Field(ge=0.0, le=1.0, allow_inf_nan=False)]


class ForceTorqueConfig(Frozen):
    """Six-axis force/torque sensor of one finger; the in-plane problem uses four of its axes."""

    rate: int = number(1, 100_000, "Samples per second; no sensor is faster [Hz]")
    noise_tangential: float = number(0.0, 1000.0, "White noise of each tangential force, sd [N]")
    noise_normal: float = number(0.0, 1000.0, "White noise of the normal force, sd [N]")
    noise_torque: float = number(0.0, 1000.0, "White noise of the torque about the normal, sd [N m]")
    bias_tangential: float = number(
        0.0, 1000.0, "Bias of each tangential force, constant per episode, sd [N]"
    )
    bias_normal: float = number(0.0, 1000.0, "Bias of the normal force, constant per episode, sd [N]")
    bias_torque: float = number(0.0, 1000.0, "Bias of the torque, constant per episode, sd [N m]")
    drift_tangential: float = number(0.0, 1000.0, "Random walk of each tangential force, sd [N/sqrt(s)]")
    drift_normal: float = number(0.0, 1000.0, "Random walk of the normal force, sd [N/sqrt(s)]")
    drift_torque: float = number(0.0, 1000.0, "Random walk of the torque, sd [N m/sqrt(s)]")
    resolution_force: float = number(0.0, 1000.0, "Quantisation of the force readings; 0: continuous [N]")
    resolution_torque: float = number(0.0, 1000.0, "Quantisation of the torque readings; 0: continuous [N m]")
    force_range: float = number(1e-6, 1e6, "Saturation of the tangential forces, either sign [N]")
    normal_range: float = number(1e-6, 1e6, "Saturation of the normal force [N]")
    torque_range: float = number(1e-6, 1e6, "Saturation of the torque, either sign [N m]")
    latency: float = number(0.0, 10.0, "Smallest latency of a reading [s]")
    latency_spread: float = number(0.0, 10.0, "Largest latency on top of that, sampled per episode [s]")
    own_latency: bool = Field(
        description="Whether each finger's sensor samples its own latency, where each has one: true or false"
    )
    tip_mass: float = number(0.0, 1.0, "Smallest mass of the fingertip in front of the sensor [kg]")
    tip_mass_spread: float = number(
        0.0, 1.0, "Largest mass on top of that, sampled per episode and finger [kg]"
    )
    mode_frequency: Annotated[float, Field(ge=1.0, le=1e4)] | None = Field(
        description="Natural frequency of the finger, see `slipgym.sensors.structure`; null: it is rigid [Hz]"
    )
    mode_damping: float = number(1e-3, 0.5, "Damping of that vibration over the critical; size assumed [-]")
    dropout: Probability = Field(description="Probability that a reading is the last one again [-]")
    tilt: float = number(0.0, 0.5, "Largest tilt of the frame about x and y, per episode [rad]")
    crosstalk: float = number(
        0.0, 0.2, "Largest part of an axis's load that another reads, over their ranges, per episode [-]"
    )
    off_centre: float = number(
        0.0, 0.05, "Largest distance of the pad's centre from its place along x and y, per episode [m]"
    )


class SlipConfig(Frozen):
    """Slip-velocity sensor of one finger: optical mouse chips on a circle, solved by least squares."""

    rate: int = number(10, 2000, "Samples per second; one per control step [Hz]")
    counts: bool = Field(
        description="Whether the chips report whole counts; if not, exact motion: true or false"
    )
    count: float = number(1e-9, 0.01, "Motion per count; 1 nm to 1 cm [m]")
    chip_radius: float = number(1e-4, 1.0, "Distance of the chips from the pad's centre [m]")
    chips: int = number(2, 4, "Number of chips, evenly spaced on their circle [-]")
    noise: float = number(0.0, 1e6, "White noise per chip axis and sample, sd [counts]")
    window: int = number(1, 15, "Length of the moving average; the history holds 16 samples [samples]")
    latency_samples: int = Field(ge=0, description="Smallest latency of a reading [samples]")
    latency_spread: int = Field(
        ge=0, description="Largest latency on top of that, sampled per episode [samples]"
    )
    own_latency: bool = Field(
        description="Whether each finger's sensor samples its own latency: true or false"
    )
    jitter: Probability = Field(description="Probability that a reading is one sample older [-]")
    dropout: Probability = Field(description="Probability that a reading is the last one again [-]")
    rest_after: float = number(0.0, 1000.0, "Time without a count after which the chips rest [s]")
    rest_period: float = number(
        0.0, 1.0, "Longest time between two looks of resting chips, sampled per episode; 0: none rests [s]"
    )
    scale_error: float = number(0.0, 0.5, "Largest relative error of the counts, per episode [-]")
    chip_failure: Probability = Field(description="Probability that one chip counts nothing, per episode [-]")
    speed_max: float = number(1e-6, 1000.0, "Saturation of each chip axis, either sign [m/s]")


class MotorConfig(Frozen):
    """Readings of a gripper without sensors in its fingers: its motor's load and its opening."""

    gain_error: float = number(0.0, 0.9, "Largest relative error of the force, per episode [-]")
    friction: float = number(
        0.0, 0.9, "Motor load over force while it closes, less 1; while it opens, 1 less it [-]"
    )
    backlash: float = number(0.0, 100.0, "Change of force in which that friction turns over [N]")
    noise: float = number(0.0, 100.0, "White noise of the force, sd [N]")
    resolution: float = number(0.0, 100.0, "Quantisation of the force; 0: continuous [N]")
    opening_noise: float = number(0.0, 0.1, "White noise of the opening, sd [m]")


class MarkersConfig(Frozen):
    """Markers in a gel in front of a camera: a field of shear, from which the forces along the pad come."""

    compliance: float = number(
        1e-8, 1.0, "Displacement of a marker over the force on its part of the pad [m/N]"
    )
    noise: float = number(0.0, 0.01, "Noise of a marker per axis and frame, sd [m]")
    latency_frames: int = number(0, 3, "Latency of a frame [frames]")
    gain_error: float = number(0.0, 0.9, "Largest relative error of the gel's compliance, per episode [-]")
    normal_error: float = number(0.0, 0.9, "Largest relative error of the normal force, per episode [-]")
    observed: bool = Field(description="Whether observations have the field, 252 columns: true or false")


class SensorsConfig(Frozen):
    """The sensors of each finger, or of the gripper as a whole."""

    place: Literal["fingers", "wrist", "motor"] = Field(
        description="Where forces are measured: both fingers, the wrist, or the motor alone"
    )
    interval: int = number(1, 100, "Control steps between two readings [-]")
    force_torque: ForceTorqueConfig = Field(description="Force/torque sensor")
    slip: SlipConfig = Field(description="Slip-velocity sensor")
    motor: MotorConfig = Field(description="Load and opening of the gripper's motor, unless in fingers")
    markers: MarkersConfig | None = Field(
        description="Markers in the pads; null: force/torque sensors behind them"
    )

    @model_validator(mode="after")
    def _markers_need_fingers(self) -> Self:
        if self.markers is not None and self.place != "fingers":
            raise ValueError(f'markers are in the pads: place must be "fingers", got "{self.place}"')
        return self

    @property
    def usual(self) -> bool:
        """Whether each finger has a force/torque and a slip-velocity sensor, read in every control step."""
        return self.place == "fingers" and self.markers is None and self.interval == 1
