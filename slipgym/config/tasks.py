"""What each task asks for."""

from pydantic import Field

from slipgym.config.base import Frozen, Interval, NonNegative, Positive, PositiveInterval
from slipgym.config.hardware import ObjectConfig


class TaskConfig(Frozen):
    """What every task has."""

    initial_force: Positive = Field(description="Force per finger at reset [N]")
    object: ObjectConfig | None = Field(description="The object of this task; null: the common one [-]")
    mass_range: PositiveInterval | None = Field(
        description="The object's mass is drawn from this range; null: the object's own [kg]"
    )
    radius: Positive | None = Field(
        description="Radius r of the equivalent rim contact in this task, also nominal; null: the common [m]"
    )
    reward: Frozen = Field(description="Scales of the reward terms [-]")


class LinearSlipReward(Frozen):
    """Scales of the reward terms of LinearSlip."""

    tracking: float = Field(description="Scale of exp(-(error / tolerance)^2) against the reference [-]")
    sideways: float = Field(description="Scale of -(|x| + pad_radius |theta|) / tolerance [-]")
    effort: float = Field(description="Scale of -(mean grip force / force_max) [-]")
    smoothness: float = Field(description="Scale of -(change of the command / force_max)^2 [-]")
    drop: float = Field(description="Scale of -1 on a drop [-]")


class HoldReward(Frozen):
    """Scales of the reward terms of Hold."""

    still: float = Field(description="Scale of exp(-(slip / tolerance)^2) [-]")
    effort: float = Field(description="Scale of -(mean grip force / force_max) [-]")
    smoothness: float = Field(description="Scale of -(change of the command / force_max)^2 [-]")
    drop: float = Field(description="Scale of -1 on a drop [-]")


class RotationalSlipReward(Frozen):
    """Scales of the reward terms of RotationalSlip."""

    tracking: float = Field(description="Scale of exp(-(error / tolerance)^2) against the reference [-]")
    sliding: float = Field(description="Scale of -slip / slide_tolerance [-]")
    effort: float = Field(description="Scale of -(mean grip force / force_max) [-]")
    smoothness: float = Field(description="Scale of -(change of the command / force_max)^2 [-]")
    drop: float = Field(description="Scale of -1 on a drop [-]")


class HingeReward(Frozen):
    """Scales of the reward terms of Hinge."""

    still: float = Field(description="Scale of exp(-(slip / slide_tolerance)^2) [-]")
    upright: float = Field(description="Scale of exp(-(tilt / tilt_tolerance)^2) [-]")
    effort: float = Field(description="Scale of -(mean grip force / force_max) [-]")
    smoothness: float = Field(description="Scale of -(change of the command / force_max)^2 [-]")
    drop: float = Field(description="Scale of -1 on a drop [-]")


class PlanarSlipReward(Frozen):
    """Scales of the reward terms of PlanarSlip."""

    position: float = Field(description="Scale of exp(-(error in (x, y) / tolerance)^2) [-]")
    angle: float = Field(description="Scale of exp(-(error in theta / angle_tolerance)^2) [-]")
    distance: float = Field(description="Scale of -mean of both errors over their tolerances [-]")
    effort: float = Field(description="Scale of -(mean grip force / force_max) [-]")
    smoothness: float = Field(description="Scale of -(change of the command / force_max)^2 [-]")
    wrist: float = Field(description="Scale of -(commanded wrist velocity over its limits)^2 [-]")
    drop: float = Field(description="Scale of -1 on a drop [-]")


class LinearSlipConfig(TaskConfig):
    """The object slides down between the pads by a given distance in a given time, then stays."""

    distance: Positive = Field(description="Distance to slide [m]")
    duration: Positive = Field(description="Time for the slide [s]")
    settle: NonNegative = Field(description="Time before the slide, during which the object is held [s]")
    hold: NonNegative = Field(description="Time after the slide, during which the object is held [s]")
    tolerance: Positive = Field(description="Largest error of the final position for success [m]")
    reward: LinearSlipReward = Field(description="Scales of the reward terms [-]")


class HoldConfig(TaskConfig):
    """The object is to stay in the grip while the wrist shakes and something pokes the object."""

    duration: Positive = Field(description="Length of an episode [s]")
    tolerance: Positive = Field(description="Largest slip for success [m]")
    shake_amplitude: NonNegative = Field(description="Amplitude of the wrist's shaking along x and z [m]")
    shake_pitch: NonNegative = Field(description="Amplitude of the wrist's shaking in pitch [rad]")
    shake_frequency: PositiveInterval = Field(
        description="The shaking's frequency is drawn from this range [Hz]"
    )
    poke_impulse: Interval = Field(description="The impulse of a poke is drawn from this range [N s]")
    poke_offset: NonNegative = Field(description="Lever of a poke about the centre of mass, at most [m]")
    poke_interval: PositiveInterval = Field(description="The time between pokes is drawn from this range [s]")
    poke_duration: Positive = Field(description="Length of a poke [s]")
    reward: HoldReward = Field(description="Scales of the reward terms [-]")


class RotationalSlipConfig(TaskConfig):
    """The object turns between the pads by a given angle in a given time, then stays."""

    angle: Positive = Field(description="Angle to turn [rad]")
    duration: Positive = Field(description="Time for the turn [s]")
    settle: NonNegative = Field(description="Time before the turn, during which the object is held [s]")
    hold: NonNegative = Field(description="Time after the turn, during which the object is held [s]")
    tolerance: Positive = Field(description="Largest error of the final angle for success [rad]")
    slide_tolerance: Positive = Field(description="Largest slip at the pad centre for success [m]")
    reward: RotationalSlipReward = Field(description="Scales of the reward terms [-]")


class HingeConfig(TaskConfig):
    """The object hangs upright between the pads while the wrist pitches."""

    turn: Positive = Field(description="Angle by which the wrist pitches [rad]")
    duration: Positive = Field(description="Time for it [s]")
    settle: NonNegative = Field(description="Time before the wrist moves [s]")
    hold: NonNegative = Field(description="Time after it has moved [s]")
    slide_tolerance: Positive = Field(description="Largest slip at the pad centre for success [m]")
    tilt_tolerance: Positive = Field(description="Largest tilt of the object for success [rad]")
    reward: HingeReward = Field(description="Scales of the reward terms [-]")


class PlanarSlipConfig(TaskConfig):
    """The object is moved in the grip to a given pose (x, y, theta)."""

    slide: PositiveInterval = Field(description="The target's slide is drawn from this range [m]")
    heading: NonNegative = Field(description="Largest pitch of the wrist during the target's slide [rad]")
    turn: PositiveInterval = Field(
        description="The target's turn, either way, is drawn from this range [rad]"
    )
    duration: Positive = Field(description="Length of an episode [s]")
    tolerance: Positive = Field(description="Largest final error in (x, y) for success [m]")
    angle_tolerance: Positive = Field(description="Largest final error in theta for success [rad]")
    rest_speed: Positive = Field(description="Largest final slip speed at the pad's rim for success [m/s]")
    reward: PlanarSlipReward = Field(description="Scales of the reward terms [-]")


class TasksConfig(Frozen):
    """Parameters of the tasks, one group each."""

    linear_slip: LinearSlipConfig = Field(description="slipgym/LinearSlip [-]")
    hold: HoldConfig = Field(description="slipgym/Hold [-]")
    rotational_slip: RotationalSlipConfig = Field(description="slipgym/RotationalSlip [-]")
    hinge: HingeConfig = Field(description="slipgym/Hinge [-]")
    planar_slip: PlanarSlipConfig = Field(description="slipgym/PlanarSlip [-]")
