"""Imitates a controller in rounds of episodes: DAgger.

S. Ross, G. Gordon, D. Bagnell, A reduction of imitation learning and structured prediction to no-regret
online learning, AISTATS 2011. The network acts, the controller with the true friction says what it would
have done, and the network is fitted to what it said in all rounds so far.
"""

from __future__ import annotations

import math
import os
import shutil
from collections.abc import Iterator, Sequence
from contextlib import closing
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import torch
from tqdm import tqdm

from policies.learned import files
from policies.learned.description import Column
from policies.learned.export import described, origin
from policies.learned.fitting import column_of
from policies.learned.policy import Network
from policies.training import seeds
from policies.training.imitation.config import Imitation
from policies.training.imitation.episodes import Demonstrations, Scene, arguments, demonstrate
from policies.training.imitation.student import NORMALISATION, Student, network_of
from slipgym import atomic_io
from slipgym.tasks import find

POLICY, UNFINISHED = "policy", "unfinished"
"""Folder of the policy, and of those of a run that is not over."""
LIMIT = 1.0
"""Largest norm of a gradient."""


@dataclass(frozen=True)
class Outcome:
    """State of an imitation after a round.

    Attributes:
        weights: Tensors of the network, see `policies.learned.files.expected`.
        curve: Of each round: its number, episodes so far, share that the network solved, loss at its end.
        steps: Steps of experience.
    """

    weights: dict[str, np.ndarray]
    curve: list[dict[str, float]]
    steps: int


def imitate(
    config: Imitation, output: str | os.PathLike[str], seed: int = 0, command: str = ""
) -> tuple[Path, float]:
    """Trains a network and writes it as a policy (docs/policy_files.md), with its curve beside it.

    Returns:
        The run's folder in `output`, which holds the folder "policy" and curve.csv, and the share of held-out
        episodes that it solves. Until the run is over the last round's policy is in "unfinished" instead.

    Raises:
        FileExistsError: The run's folder is there already.
        FloatingPointError: The loss is not finite.
        OSError: The output cannot be written, which is found out before the training.
    """
    folder = destination(config, output, seed)
    where = described(find(config.task).id, arguments(config))

    def write(path: Path, outcome: Outcome) -> None:
        description = {
            "environment": where,
            "network": network_of(config).model_dump(mode="json"),
            "normalisation": NORMALISATION.model_dump(mode="json"),
            "origin": origin("DAgger", command, outcome.steps, [seed], critic=None),
        }
        files.write(path, description, outcome.weights)
        curve = pd.DataFrame(outcome.curve).to_csv(index=False, lineterminator="\n")
        atomic_io.write(folder / "curve.csv", curve.encode())

    outcome: Any = None
    for outcome in run(config, seed):
        rounds = len(outcome.curve)
        write(folder / UNFINISHED / f"round_{rounds}", outcome)
        shutil.rmtree(folder / UNFINISHED / f"round_{rounds - 1}", ignore_errors=True)
    solved = judged(config, Network(network_of(config), NORMALISATION, outcome.weights))
    write(folder / POLICY, outcome)
    shutil.rmtree(folder / UNFINISHED, ignore_errors=True)
    return folder, solved


def destination(config: Imitation, output: str | os.PathLike[str], seed: int) -> Path:
    """The folder of a run, which does not exist and can be made.

    Raises:
        FileExistsError: It is there already.
        OSError: It cannot be made.
    """
    folder = Path(output) / f"{find(config.task).key}_{config.environment.friction_source}_{seed}"
    if os.path.exists(folder):
        unfinished = "" if (folder / POLICY).exists() else f" (not finished, its policy is in {UNFINISHED})"
        raise FileExistsError(f"{folder} is there already{unfinished}; choose another output or seed")
    atomic_io.check_folder(folder)
    return folder


def run(config: Imitation, seed: int) -> Iterator[Outcome]:
    """Trains a network, see `imitate`; yields what there is after each round."""
    torch.set_num_threads(config.threads)
    torch.manual_seed(seed)
    rng = np.random.default_rng(seed)
    data: list[Demonstrations] = []
    fit: Any = None
    curve = []
    with closing(Scene(config, config.rows)) as scene, tqdm(range(config.rounds), desc="rounds") as bar:
        columns = [column_of(column) for column in scene.envs.action_columns]
        for number in bar:
            acts = np.arange(config.rows) >= config.controlled * config.rows
            network = None if fit is None else fit.network()
            first = seeds.training(seed) + number * config.rows
            data.append(demonstrate(scene, network, acts, first))
            fit = fit or Fit(config, data[0], columns)
            loss = fit.update(data, rng)
            solved = float("nan") if network is None else float(data[-1].solved[acts].mean())
            episodes, steps = len(data) * config.rows, int(sum(one.lengths.sum() for one in data))
            curve.append({"round": number, "episodes": episodes, "solved": solved, "loss": loss})
            bar.set_postfix(loss=f"{loss:.3g}", solved=f"{solved:.0%}")
            yield Outcome(fit.student.tensors(), curve, steps)


def judged(config: Imitation, network: Network) -> float:
    """Share of the held-out episodes that a network solves; NaN without any."""
    if not config.held_out:
        return math.nan
    with closing(Scene(config, config.held_out)) as scene:
        everywhere = np.ones(config.held_out, dtype=bool)
        return float(demonstrate(scene, network, everywhere, seeds.held_out(0)).solved.mean())


class Fit:
    """Fits the network to the episodes of all rounds; those of the first one normalise the observations."""

    def __init__(self, config: Imitation, first: Demonstrations, components: Sequence[Column]) -> None:
        running = np.arange(len(first.observations))[:, None] < first.lengths
        seen = first.observations[running].astype(np.float64)
        self._config = config
        self.student = Student(config, seen.mean(axis=0), seen.var(axis=0), components)
        self._adam = torch.optim.Adam(self.student.parameters(), config.learning_rate)
        total = config.rounds * config.updates
        self._schedule = torch.optim.lr_scheduler.CosineAnnealingLR(self._adam, total)

    def update(self, data: Sequence[Demonstrations], rng: np.random.Generator) -> float:
        """Makes the updates of a round and returns their mean loss.

        Raises:
            FloatingPointError: The loss is not finite.
        """
        total = 0.0
        for _ in range(self._config.updates):
            one = data[int(rng.integers(len(data)))]
            rows = rng.choice(len(one.lengths), min(self._config.batch, len(one.lengths)), replace=False)
            length = one.lengths[rows].max()
            parts = one.observations[:length, rows], one.actions[:length, rows], one.lengths[rows]
            loss = self.student.loss(*(torch.from_numpy(part) for part in parts))
            self._adam.zero_grad()
            loss.backward()
            torch.nn.utils.clip_grad_norm_(self.student.parameters(), LIMIT)
            self._adam.step()
            self._schedule.step()
            total += loss.item()
        if not math.isfinite(total):
            raise FloatingPointError("the loss is not finite; a smaller learning_rate may help")
        return total / self._config.updates

    def network(self) -> Network:
        """The present network as it acts."""
        return Network(network_of(self._config), NORMALISATION, self.student.tensors())
