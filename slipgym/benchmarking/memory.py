"""Measures the memory per environment of a vector environment."""

from __future__ import annotations

from dataclasses import fields

from slipgym.envs.vector_env import SlipVectorEnv


def bytes_per_environment(env: SlipVectorEnv) -> float:
    """Bytes of all arrays that last from step to step, over the number of environments.

    Python's own objects come on top: a random generator, the description of the box, the name of the
    material and what the randomization drew.
    """
    state = env.get_state()
    plant = [getattr(state.simulation.plant, field.name) for field in fields(state.simulation.plant)]
    arrays = [*plant, *state.simulation.arrays.values(), state.frames]
    return sum(array.nbytes for array in arrays if array is not None) / env.num_envs
