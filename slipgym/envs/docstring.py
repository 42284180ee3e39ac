"""Generates the docstring of an environment from its task's file and the tables in the code.

The docstring of a task's module is a summary and sections under second-level headings, as in `TITLES`.
"Description", "Starting State" and "Version History" are copied; "Rewards" is appended to the table of terms,
and "Info" holds the row of `reference`. "Action Space" and "Episode End" replace the defaults in this module.
Sections without content are left out.
"""

from __future__ import annotations

import inspect
import re

from slipgym.config import Config, load
from slipgym.envs.arguments import ScalarArguments, fields
from slipgym.envs.infos import FLAGS, NUMBERS
from slipgym.envs.observation import FRICTION_COLUMNS, columns
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
One step is one control step of 1/120 s, in which the slip-velocity sensors are sampled once. The pad frame
moves with the wrist: x and y span the contact plane (x is horizontal and y points up while the wrist is
level). Angles and torques are positive about the grip axis from finger 1 to finger 2. All units are SI. An
estimator computes friction from force, torque and slip velocity while the object slips."""

_ACTION = """\
`Box(-1, 1, (1,), float32)`: the grip force commanded to both fingers; -1 is `gripper.force_min` ({low:g} N)
and +1 is `gripper.force_max` ({high:g} N). Values outside [-1, 1] are clipped; NaN and infinity are errors.
The actuator force follows the command with a dead time ({dead:g} ms) and a first-order lag ({lag:g} ms).

Other values of `action_mode` add the wrist's velocity, change the meaning of the force or scale it
geometrically (see docs/modes.md)."""

_OBSERVATION = """\
`Box(low, high, ({n},), float32)`. Forces, torques and velocities are sensor readings at the centre of
pressure. Indices {span} are the friction part, which `friction_source="none"` leaves out (the shape is then
({bare},)). The bounds depend on the configuration; with the default configuration they are

{table}

With `friction_source="estimated"` the friction part merges both fingers' estimates by their confidence, and
the confidence (0 to 1) says how much data each value rests on: an estimate is unreliable while its confidence
is low. With "true" and "nominal" every confidence is 1.

The arguments `action_mode`, `observation_mode`, `load_columns`, `history` and `estimator` add columns or
leave some out (see docs/modes.md)."""

_END = """\
- Terminated: the object is dropped, that is, neither pad touches it or a pad reaches beyond its edge.
- Truncated: the episode has its full length, `finished` in the info. The environment truncates by itself; no
  `TimeLimit` is needed. Nothing follows: the value of the last state is 0."""

_DROPPED = """\
An object is dropped when neither pad touches it or a pad reaches beyond its edge. The environment truncates
by itself; no `TimeLimit` is needed. At the full length, `finished` in the info, nothing follows: the value of
the last state is 0."""

_REWARDS = """\
The reward of a control step is the sum of these terms. A dense term pays its value, limited to [-1, 1], times
scale / (control steps of the episode) in every step, so that its sum over an episode stays within its scale.
An event pays value times scale when it happens. The scales stand under `tasks.{key}.reward` in the
configuration; docs/rewards.md explains them."""

_STARTING = """\
Every task samples the material, if `material` is "random", the sensors' biases, and the fractions of a count
in the slip sensors. Grip and sensors run for six control steps before time 0. The pads begin
without a load. A weight that hangs in the grip overshoots as it comes on, so that a grip (`initial_force`)
just above the least one may let the object go; the higher friction is, the larger is that range."""

_REWARD_TERMS = (
    "`reward_terms`",
    "what each reward term pays in this step, by name; they add up to the reward",
)
_DRAWN = """\
With `estimator=None` an info has no `estimated` and no `estimated_per_finger`.

With a randomization, the info of a reset also holds `drawn`: the values sampled for the episode, by name (see
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
    sections = {
        "Description": _joined(own.get("Description", ""), _FRAMES),
        "Action Space": own.get("Action Space") or _action(config),
        "Observation Space": _observation(config, task),
        "Rewards": _joined(_rewards(task), own.get("Rewards", "")),
        "Starting State": _joined(own["Starting State"], _STARTING) if "Starting State" in own else "",
        "Episode End": _joined(own["Episode End"], _DROPPED) if "Episode End" in own else _END,
        "Arguments": _arguments(task),
        "Reset Options": _options(task),
        "Info": _infos(own.get("Info")),
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
    rows = [
        (f"`{term.name}`", "event" if term.event else "dense", f"{term.scale:g}", term.meaning)
        for term in task.terms
    ]
    table = _table(("Term", "Paid", "Scale", "Value before scaling"), rows)
    return f"{_REWARDS.format(key=task.key)}\n\n{table}"


def _arguments(task: Task) -> str:
    rows = []
    for field in fields(ScalarArguments).values():
        default = repr(field.default).replace("'", '"')
        own = f' (here `"{task.action_mode}"`)' if field.name == "action_mode" else ""
        rows.append((f"`{field.name}`", f"`{default}`", f"{field.text}{own}"))
    return _table(("Argument", "Default", "Meaning"), rows)


def _infos(reference: str | None) -> str:
    """The table of infos; a task's page may hold its own row of `reference`."""
    rows = []
    for info in (*NUMBERS, *FLAGS):
        shape = f", {info.shape}".replace(", ()", "")
        unit = f" [{info.unit}]" if info.unit else ""
        rows.append((f"`{info.name}`", f"{info.meaning}{shape}{unit}"))
        if info.name == "reference" and reference is not None:
            rows[-1] = tuple(cell.strip() for cell in reference.strip().strip("|").split(" | "))
    return f"{_table(('Key', 'Content'), [*rows, _REWARD_TERMS])}\n\n{_DRAWN}"


def _options(task: Task) -> str:
    fields = task.options.model_fields
    rows = [(f"`{name}`", field.description or "") for name, field in fields.items()]
    head = "Parameters that `reset(options={...})` can fix for one episode; unknown names are errors."
    return f"{head}\n\n{_table(('Option', 'Meaning'), rows)}"
