"""The checker passes what Gymnasium's own vector environments do, and finds every planted fault."""

import time

import gymnasium as gym
import numpy as np
import pytest
from gymnasium.vector import AutoresetMode, SyncVectorEnv

from tests.vector_checker import check_vector_env

NEXT, SAME, DISABLED = AutoresetMode.NEXT_STEP, AutoresetMode.SAME_STEP, AutoresetMode.DISABLED


class Walk(gym.Env):
    """A random walk whose episodes have drawn lengths."""

    observation_space = gym.spaces.Box(-100.0, 100.0, (2,), np.float32)
    action_space = gym.spaces.Box(-1.0, 1.0, (1,), np.float32)

    def reset(self, *, seed=None, options=None):
        super().reset(seed=seed)
        self.state, self.left = self.np_random.normal(size=2), self.np_random.integers(4, 9)
        return self.state.astype(np.float32), self.info()

    def step(self, action):
        self.state += action + self.np_random.normal(size=2)
        self.left -= 1
        return self.state.astype(np.float32), float(self.state[0]), False, bool(self.left == 0), self.info()

    def info(self):
        return {
            "left": int(self.left),
            "state": self.state.copy(),
            "nested": {"sum": float(self.state.sum())},
        }


class Walks(SyncVectorEnv):
    def __init__(self, n, mode, env=Walk, **arguments):
        super().__init__([env] * n, autoreset_mode=mode, **arguments)


def test_passes_the_walk():
    check_vector_env(Walks)


def test_passes_gymnasiums_own():
    def native(n, mode):
        return gym.make_vec("CartPole-v1", num_envs=n, vectorization_mode="vector_entry_point")

    check_vector_env(native, modes=(None,))
    check_vector_env(
        lambda n, mode: SyncVectorEnv([lambda: gym.make("CartPole-v1")] * n, autoreset_mode=mode)
    )


class WideObservations(Walks):
    def reset(self, **arguments):
        observations, infos = super().reset(**arguments)
        return observations.astype(np.float64), infos


class OtherSpace(Walks):
    def __init__(self, n, mode):
        super().__init__(n, mode)
        self.observation_space = gym.spaces.Box(-100.0, 100.0, (n, 3), np.float32)


class LyingMode(Walks):
    def __init__(self, n, mode):
        super().__init__(n, mode)
        self.metadata["autoreset_mode"] = NEXT


class NamedMode(Walks):
    def __init__(self, n, mode):
        super().__init__(n, mode)
        self.metadata["autoreset_mode"] = mode.value


class Changed(Walks):
    """Changes what `step` returned before passing it on."""

    def step(self, actions):
        return self.change(*super().step(actions))


class ColumnRewards(Changed):
    def change(self, observations, rewards, terminated, truncated, infos):
        return observations, rewards[:, None], terminated, truncated, infos


class LostReward(Changed):
    def change(self, observations, rewards, terminated, truncated, infos):
        rewards[1] = np.nan
        return observations, rewards, terminated, truncated, infos


class FarOut(Changed):
    def change(self, observations, rewards, terminated, truncated, infos):
        observations[2] = 1e3
        return observations, rewards, terminated, truncated, infos


class NoMask(Changed):
    def change(self, *said):
        del said[-1]["nested"]["_sum"]
        return said


class OneMaskForAll(Changed):
    def change(self, *said):
        said[-1]["_left"] = said[-1]["_state"]
        return said


class Clock(Changed):
    def change(self, *said):
        now = np.full(self.num_envs, time.perf_counter())
        return *said[:-1], {**said[-1], "now": now, "_now": np.ones(self.num_envs, dtype=bool)}


class NoFinalObservation(Changed):
    def change(self, *said):
        for key in ("final_obs", "_final_obs"):
            said[-1].pop(key, None)
        return said


class FinalMaskForAll(Changed):
    def change(self, *said):
        if "_final_info" in said[-1]:
            said[-1]["_final_info"][:] = True
        return said


class FinalObservationOfTheNext(Changed):
    def change(self, observations, *said):
        for i in np.flatnonzero(said[-1].get("_final_obs", [])):
            said[-1]["final_obs"][i] = observations[i].copy()
        return observations, *said


class RewardedReset(Changed):
    def change(self, observations, rewards, *said):
        return observations, rewards + 1.0, *said


class OwnState(Changed):
    """Hands out an array that the walk goes on from."""

    def change(self, *said):
        state = np.zeros((self.num_envs, 2))
        for row, env in zip(state, self.envs, strict=True):
            row[:] = env.state
            env.state = row
        said[-1]["state"] = state
        return said


class Late(Walks):
    """Resets a step too late, and keeps quiet about it."""

    def __init__(self, n, mode):
        super().__init__(n, mode)
        self.waited = np.zeros(n, dtype=bool)

    def step(self, actions):
        over = self._autoreset_envs & ~self.waited
        self._autoreset_envs = self._autoreset_envs & self.waited
        observations, rewards, terminated, truncated, infos = super().step(actions)
        rewards[over], terminated[over], truncated[over] = 0.0, False, False
        self._autoreset_envs[over], self.waited = True, over
        return observations, rewards, terminated, truncated, infos


class Early(Walks):
    """Resets at once though it says that the next step will."""

    def step(self, actions):
        self.autoreset_mode = SAME
        said = super().step(actions)
        self._autoreset_envs[:] = False
        return said


class ResetsAll(Walks):
    def reset(self, *, seed=None, options=None):
        everyone = np.ones(self.num_envs, dtype=bool)
        return super().reset(
            seed=seed, options=options and {"reset_mask": everyone & options["reset_mask"].any()}
        )


class SilentlyResetsAll(Walks):
    """Resets rows that are not in the mask, without showing it at once."""

    def reset(self, *, seed=None, options=None):
        mask = None if options is None else options["reset_mask"].copy()
        said = super().reset(seed=seed, options=options)
        for i, env in enumerate(self.envs):
            if mask is not None and not mask[i]:
                env.left = 5
        return said


class MaskForAll(Walks):
    def reset(self, *, seed=None, options=None):
        observations, infos = super().reset(seed=seed, options=options)
        infos["_left"][:] = True
        return observations, infos


class AnyMask(Walks):
    def reset(self, *, seed=None, options=None):
        if options and not np.any(options["reset_mask"]):
            options = None
        return super().reset(seed=seed, options=options)


class Unseeded(Walks):
    def reset(self, *, seed=None, options=None):
        return super().reset(seed=None, options=options)


class SameSeedForAll(Walks):
    def reset(self, *, seed=None, options=None):
        if isinstance(seed, int):
            seed = [seed] * self.num_envs
        return super().reset(seed=seed, options=options)


class OtherSeeds(Walks):
    def reset(self, *, seed=None, options=None):
        if isinstance(seed, int):
            seed = [seed + 10 * i for i in range(self.num_envs)]
        return super().reset(seed=seed, options=options)


class Repeating(Walks):
    def reset(self, *, seed=None, options=None):
        self.last = seed if seed is not None else getattr(self, "last", None)
        return super().reset(seed=self.last, options=options)


class NotClosable(Walks):
    def close(self, **arguments):
        if self.closed:
            raise AssertionError("closed twice")
        super().close(**arguments)


@pytest.mark.parametrize(
    ("broken", "message", "modes"),
    [
        (lambda n, mode: Walks(n, mode, copy=False), "changed what .* had returned", [NEXT]),
        (WideObservations, r"observations are float64 \(3, 2\), not float32", [NEXT]),
        (OtherSpace, "observation_space is .*, not 3 times", [NEXT]),
        (LyingMode, "asked for was AutoresetMode.SAME_STEP", [SAME]),
        (NamedMode, "is no AutoresetMode", [NEXT]),
        (ColumnRewards, r"rewards must be an array \(3,\) of floats", [NEXT]),
        (LostReward, "the reward of row .1. is not finite", [NEXT]),
        (FarOut, "the observation of row 2 is outside", [NEXT]),
        (NoMask, r"infos\['nested'\]\['sum'\] has no mask '_sum'", [NEXT]),
        (OneMaskForAll, r"\['_left'\] and .*\['_state'\] share memory", [NEXT]),
        (Clock, r"event 1 \(step\), info\['now'\]", [NEXT]),
        (NoFinalObservation, r"infos\['_final_obs'\] is .* row", [SAME]),
        (FinalMaskForAll, r"infos\['_final_info'\] is .* row", [SAME]),
        (FinalObservationOfTheNext, "share memory|NextStep and SameStep.*observation", [NEXT, SAME]),
        (RewardedReset, "is reset in this step, so reward", [NEXT]),
        (OwnState, "changed what|overwritten", [NEXT]),
        (Late, "other actions in the steps that reset", [NEXT]),
        (Early, "is reset in this step|other actions", [NEXT]),
        (ResetsAll, "is not in the reset_mask|is True for row", [DISABLED]),
        (
            SilentlyResetsAll,
            "NextStep and Disabled|reset by a mask|one environment with its seed",
            [NEXT, DISABLED],
        ),
        (MaskForAll, r"the mask infos\['_left'\] is True for row", [DISABLED]),
        (AnyMask, "takes a reset_mask without a True", [DISABLED]),
        (Unseeded, "reset with the same seed, differ: row 0, event 0", [NEXT]),
        (SameSeedForAll, "rows 0 and 1 are equal", [NEXT]),
        (OtherSeeds, r"one reset with the seeds \[11, 12, 13\]", [NEXT]),
        (Repeating, r"reset\(\) without a seed repeats", [DISABLED]),
        (NotClosable, "closed twice", [NEXT]),
    ],
)
def test_finds(broken, message, modes):
    with pytest.raises(AssertionError, match=message):
        check_vector_env(broken, modes=modes)


def test_says_when_nothing_ends():
    with pytest.raises(ValueError, match="no episode ends within 1 steps"):
        check_vector_env(Walks, steps=1)
