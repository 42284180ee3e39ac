"""The docstring of an environment: what its task's file says, completed by what follows from the code.

A task's page is a summary and sections under headings of the second level, as in `TITLES`. "Description",
"Starting State" and "Version History" are its own; "Rewards" follows the table of terms, "Info" holds the
row of `reference`. "Action Space" and "Episode End" replace what stands here. What is missing is left out.
"""

from __future__ import annotations

import inspect
import re
import textwrap

from slipgym.config import Config, load
from slipgym.envs.observation import FRICTION_COLUMNS, columns
from slipgym.envs.slip_env import SlipEnv
from slipgym.tasks import Task

TITLES = (
    "Description",
    "Action Space",
    "Observation Space",
    "Rewards",
    "Starting State",
    "Episode End",
    "Arguments",
    "Reset Options",
    "Info",
    "Version History",
)
"""Sections of a docstring, in order."""

_FRAMES = """\
One step is one sample of the slip-velocity sensors, 1/120 s. The pad frame moves with the wrist: x and y
span the contact plane (x horizontal and y up while the wrist is level), angles and torques count about
the grip axis from finger 1 to finger 2. All units are SI."""

_ACTION = """\
`Box(-1, 1, (1,), float32)`: the grip force commanded to both fingers; -1 is `gripper.force_min` ({low:g} N)
and +1 is `gripper.force_max` ({high:g} N). Values beyond are clipped; NaN and infinity are errors. The force
follows with a dead time ({dead:g} ms) and a first-order lag ({lag:g} ms).

Other values of `action_mode` add components or change their meaning (see docs/modes.md):
"grip_force_pitch" adds the wrist's pitch rate, "grip_force_wrist" its velocity along world x and z and
its pitch rate, "force_increment" takes the change of the grip force per sample instead."""

_OBSERVATION = """\
`Box(low, high, ({n},), float32)`. Forces, torques and velocities are measured, at the centre of pressure;
index {span} are the friction part, which `friction_source="none"` leaves out (then the shape is ({bare},)).
Bounds follow the configuration; those of the defaults are

{table}

With `friction_source="estimated"` the friction part merges both fingers' estimates by their support, and
the support (0 to 1) says how much data stands behind each: do not trust a value before it has grown. With
"true" and "nominal" every support is 1.

With an `action_mode` that moves the wrist, what the agent commands of it and its pitch precede
the friction part, unless the table has them. `observation_mode="sensor"` leaves the friction part out;
"dict" gives the groups "policy" (the above) and "privileged" (the truth); `history=k` puts the last k
observations in front of each (see docs/modes.md)."""

_END = """\
- Terminated: the object is dropped, that is, neither pad touches it or a pad reaches beyond its edge.
- Truncated: the time of the episode has passed. The environment truncates by itself; no `TimeLimit` is
  needed."""

_ARGUMENTS = {
    "friction_source": 'friction in the observation: or `"true"`, `"nominal"`, `"none"`',
    "estimator": "a name of `estimator.names()`, or a mapping with its `name` and parameters",
    "contact": 'friction model of the pads: or `"distributed"` (see `contact.pressure`)',
    "sensors": 'sensor preset: `"realistic"` or `"ideal"`',
    "material": 'name of a material, or `"random"` for another in every episode',
    "action_mode": 'what an action means, see Action Space; `None`: the task\'s own, `"{mode}"`',
    "observation_mode": 'how an observation is laid out: or `"sensor"`, `"dict"`',
    "history": "how many earlier observations come along with each",
    "randomization": 'what else is drawn: `"train"`, `"eval_ood"`, a file or a mapping',
    "engine": 'what moves the bodies: PyBullet, or `"planar"` (see docs/batch.md)',
    "frame_skip": "slip-velocity samples per step; the action is repeated, the rewards are summed",
    "render_mode": '`None`, `"rgb_array"`: 720 by 480 pictures, `"depth_array"`, `"human"`',
    "config": "file or mapping of overrides, merged over the defaults in `configs/`",
}

_INFO = """\
| Key | Content |
|---|---|
| `true` | true (mu_s, mu_c, r) now, (3,) [-, -, m] |
| `estimated` | the estimators' (mu_s, mu_c, r), mean of both fingers, (3,) |
| `estimated_per_finger` | the same, finger by finger, (2, 3) |
| `slip` | true slip displacement (x, y, theta) in the pad frame since the grasp, (3,) [m, m, rad] |
| `slip_twist` | true slip velocity (v_x, v_y, omega) at the pad centre, (3,) [m/s, m/s, rad/s] |
| `contact_wrench` | true friction (f_x, f_y, tau) of either pad on the box, (2, 3) [N, N, N m] |
| `grip_force` | actuator force of each finger, (2,) [N] |
{reference}
| `reward_terms` | scaled reward terms of this step by name; they add up to the reward |
| `time` | time since reset [s] |
| `is_success` | whether the task is solved; see Episode End |
| `dropped` | whether the box is dropped |

With a randomization, the info of a reset also holds `drawn`: what was drawn for the episode, by name (see
docs/randomization.md)."""


def docstring(task: Task) -> str:
    """The docstring of a task's environment, with the numbers of the default configuration.

    Raises:
        ValueError: The task's page has a section that is not among `TITLES`.
    """
    summary, *rest = re.split(r"^## (.+)\n", inspect.cleandoc(task.page or ""), flags=re.MULTILINE)
    own = dict(zip(rest[::2], map(str.strip, rest[1::2]), strict=True))
    for title in own:
        if title not in TITLES:
            raise ValueError(f"page of {task.id}: unknown section {title!r}; valid: {', '.join(TITLES)}")
    config = load()
    reference = own.get("Info", "| `reference` | what the task says of it, (3,) |")
    sections = {
        "Description": _joined(own.get("Description", ""), _FRAMES),
        "Action Space": own.get("Action Space") or _action(config),
        "Observation Space": _observation(config, task),
        "Rewards": _joined(_rewards(task), own.get("Rewards", "")),
        "Starting State": own.get("Starting State", ""),
        "Episode End": own.get("Episode End", _END),
        "Arguments": _arguments(task),
        "Reset Options": _options(task),
        "Info": _INFO.format(reference=reference),
        "Version History": own.get("Version History", ""),
    }
    written = [f"## {title}\n\n{sections[title]}" for title in TITLES if sections[title]]
    return _joined(summary.strip() or f"The task {task.name}.", *written) + "\n"


def _joined(*parts: str) -> str:
    return "\n\n".join(part for part in parts if part)


def _table(head: tuple[str, ...], rows: list[tuple[str, ...]]) -> str:
    lines = [head, *rows]
    written = [f"| {' | '.join(cells)} |" for cells in lines]
    return "\n".join([written[0], "|---" * len(head) + "|", *written[1:]])


def _action(config: Config) -> str:
    gripper = config.gripper
    dead, lag = 1e3 * gripper.dead_time, 1e3 * gripper.lag
    return _ACTION.format(low=gripper.force_min, high=gripper.force_max, dead=dead, lag=lag)


def _observation(config: Config, task: Task) -> str:
    named = columns(config, task, "estimated", task.action_mode)
    rows = [
        (str(k), f"`{c.name}`: {c.meaning}", f"{c.low:.4g}", f"{c.high:.4g}", c.unit)
        for k, c in enumerate(named)
    ]
    table = _table(("Index", "Observation", "Min", "Max", "Unit"), rows)
    n, bare = len(named), len(named) - len(FRICTION_COLUMNS)
    return _OBSERVATION.format(n=n, bare=bare, span=f"{bare} to {n - 1}", table=table)


def _rewards(task: Task) -> str:
    where = f"`tasks.{task.key}.reward` in the configuration"
    head = textwrap.fill(f"The sum of these terms, each times its scale ({where}), per sample:", 106)
    rows = [(f"`{term.name}`", f"{term.scale:g}", term.meaning) for term in task.terms]
    return f"{head}\n\n{_table(('Term', 'Scale', 'Value before scaling'), rows)}"


def _arguments(task: Task) -> str:
    parameters = inspect.signature(SlipEnv).parameters
    defaults = {name: repr(parameters[name].default).replace("'", '"') for name in _ARGUMENTS}
    told = {**_ARGUMENTS, "action_mode": _ARGUMENTS["action_mode"].format(mode=task.action_mode)}
    rows = [(f"`{name}`", f"`{defaults[name]}`", meaning) for name, meaning in told.items()]
    return _table(("Argument", "Default", "Meaning"), rows)


def _options(task: Task) -> str:
    fields = task.options.model_fields
    rows = [(f"`{name}`", field.description or "") for name, field in fields.items()]
    head = "What `reset(options={...})` fixes for one episode; anything else in it is an error."
    return f"{head}\n\n{_table(('Option', 'Meaning'), rows)}"
