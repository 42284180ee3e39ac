"""Writes the pages of the environments from their docstrings; shared parts stand on one page.

A docstring consists of sections, a section of blocks (paragraphs, lists, tables). A block that occurs in at
least `SHARED` docstrings, and a row of the tables in `SPLIT` that occurs in all, moves to `common.md`.
"""

import importlib
import inspect
import re
from collections import Counter

from slipgym.registration import ENVIRONMENTS

SHARED = 5
"""Docstrings that hold a block or row before it is shared."""
SPLIT = ("Observation Space", "Rewards", "Reset Options", "Info")
"""Sections whose tables are divided by rows."""
NOTE = "<!-- Made by scripts/make_docs.py from the docstrings of slipgym/tasks/. -->"
COMMON = f"""# Common to all environments

{NOTE}

The page of a task has its own description, rewards, observation columns and options; this page has those that
all tasks share. `help(env.unwrapped)` prints both together.

```python
import gymnasium as gym

env = gym.make("slipgym:slipgym/LinearSlip-v0")
```"""
LISTS = ("Reset Options", "Info")
"""Sections whose tables are lists on the page of a task."""
BEFORE = {
    "Action Space": "Unless the page of the task states another action space:",
    "Observation Space": """\
Forces, torques and velocities are sensor readings at the centre of pressure. The last six columns are the
friction part, which `friction_source="none"` leaves out; negative indices count from the end. The bounds
depend on the configuration; with the default configuration they are""",
}
"""Text of the common page ahead of what is shared in a section."""
OBSERVED = r"\1 The columns that are not here stand on the [common page](common.md#observation-space)."
Sections = dict[str, list[str]]


def sections(environment: type) -> Sections:
    """Title -> blocks of an environment's docstring; the summary has the title ""."""
    key = environment.task.key
    text = (inspect.getdoc(environment) or "").replace(f"`tasks.{key}.reward`", "`tasks.<task>.reward`")
    text = re.sub(r' \(here `"\w+"`\) \|$', " |", text, flags=re.MULTILINE)
    text = re.sub(
        r"(`Box\(low, high, .*?\.) Forces.*?with the default configuration they are",
        OBSERVED,
        text,
        flags=re.DOTALL,
    )
    text = re.sub(r"\(see\s+docs/", "(docs/", text)
    summary, *rest = re.split(r"^## (.+)\n", text, flags=re.MULTILINE)
    parts = {"": summary, **dict(zip(rest[::2], rest[1::2], strict=True))}
    return {title: part.strip().split("\n\n") for title, part in parts.items()}


def rows(title: str, block: str) -> list[str]:
    """Rows of a table, without its head; those of the friction part have indices from the end."""
    found = block.splitlines()[2:]
    if title != "Observation Space":
        return found
    cells = [row.split(" | ", 1) for row in found]
    first = next(k for k, (_, rest) in enumerate(cells) if rest.startswith("`mu_s`"))
    return [
        row if k < first else f"| {k - len(found)} | {rest}"
        for k, (row, (_, rest)) in enumerate(zip(found, cells, strict=True))
    ]


def is_split(title: str, block: str) -> bool:
    """Whether a block is a table that is divided by rows."""
    return title in SPLIT and block.startswith("|")


def pieces(title: str, block: str) -> list[str]:
    """What is shared or not of a block: its rows, or the block."""
    return rows(title, block) if is_split(title, block) else [block]


def written(title: str, blocks: list[str], keep: set[str], kept: bool) -> list[str]:
    """The blocks of a section whose pieces are in `keep`, or are not."""
    found = []
    for block in blocks:
        chosen = [piece for piece in pieces(title, block) if (piece in keep) == kept]
        if chosen:
            head = block.splitlines()[:2] if is_split(title, block) else []
            found.append("\n".join([*head, *chosen]))
    return found


def linked(text: str) -> str:
    """The text with links in place of paths of pages."""
    return re.sub(r"docs/(?:environments/)?(\w+)\.md", r"[\1](../\1.md)", text)


def pages() -> dict[str, str]:
    """File name -> page, of every registered environment, and of what they share."""
    found: dict[str, tuple[type, Sections]] = {}
    for entry_point in ENVIRONMENTS.values():
        module, _, cls = entry_point.partition(":")
        environment = getattr(importlib.import_module(module), cls)
        found[environment.task.key] = (environment, sections(environment))
    counts = Counter(
        (title, piece)
        for _, parts in found.values()
        for title, blocks in parts.items()
        for block in blocks
        for piece in set(pieces(title, block))
    )
    shared: dict[str, set[str]] = {}
    for (title, piece), count in counts.items():
        needed = len(found) if title not in ("Rewards", "Action Space") and piece.startswith("|") else SHARED
        moves = count >= needed and not piece.startswith("`Box(low")  # the number of columns is a task's own
        shared.setdefault(title, set()).update([piece] if moves else [])
    texts = {f"{key}.md": page(environment, parts, shared) for key, (environment, parts) in found.items()}
    return {"common.md": common([parts for _, parts in found.values()], shared), **texts}


def page(environment: type, parts: Sections, shared: dict[str, set[str]]) -> str:
    """The page of one environment.

    Args:
        environment: Its class.
        parts: Its sections.
        shared: Title -> pieces that stand on the common page.
    """
    task = environment.task
    text = [
        f"# {task.id}\n\n{NOTE}",
        parts[""][0],
        f"![{task.name}: view and plots of an episode](../images/{task.key}.png)",
        "Arguments, action modes and everything else that is not here: [common](common.md).",
    ]
    for title, blocks in parts.items():
        own = written(title, blocks, shared[title], kept=False)
        if title == "Action Space" and not own:
            own = [f"{re.split('[;.] ', ' '.join(blocks[0].split()))[0]} ([common](common.md#action-space))."]
        if title == "Rewards":
            others = [names(block, shared[title]) for block in blocks if is_split(title, block)]
            own += [f"Terms of most tasks, described on the [common page](common.md#rewards): {others[0]}."]
        if title in LISTS:
            own = [re.sub(r"^\| (.+?) \| (.+) \|$", r"- \1: \2", "\n".join(rows(title, own[0])), flags=re.M)]
        if title and own:
            text += [f"## {title}", *own]
    return linked("\n\n".join(text)) + "\n"


def names(block: str, keep: set[str]) -> str:
    """First cells of the rows of a table that stand on the common page."""
    return ", ".join(row.split(" | ")[0].removeprefix("| ") for row in block.splitlines() if row in keep)


def common(every: list[Sections], shared: dict[str, set[str]]) -> str:
    """The page of what the environments share.

    Args:
        every: Sections of each environment.
        shared: Title -> pieces of this page.
    """
    text = [COMMON]
    for title in every[0]:
        blocks = max((written(title, parts[title], shared[title], kept=True) for parts in every), key=len)
        blocks = [whole(title, block, every, shared[title]) for block in blocks]
        if title and blocks:
            text += [f"## {title}", *([BEFORE[title]] if title in BEFORE else []), *blocks]
    return linked("\n\n".join(text)) + "\n"


def whole(title: str, block: str, every: list[Sections], keep: set[str]) -> str:
    """A table of the common page with the shared rows of all environments, in place of those of one."""
    if not is_split(title, block):
        return block
    found = dict.fromkeys(
        row
        for parts in every
        for other in parts[title]
        if is_split(title, other)
        for row in pieces(title, other)
        if row in keep
    )
    return "\n".join([*block.splitlines()[:2], *found])
