"""The state of a run between two batches of episodes, from which it continues bit for bit."""

from __future__ import annotations

import io
import warnings
from pathlib import Path
from typing import Any

import numpy as np
import torch
from stable_baselines3.common.base_class import BaseAlgorithm
from stable_baselines3.common.off_policy_algorithm import OffPolicyAlgorithm

from agents.learning.episodes import EpisodeVecEnv
from agents.seal import sealed, unsealed
from flexarm_env.errors import InputError
from flexarm_env.files import read_whole, write_whole

MARK = b"flexarm-checkpoint-1\n"
LARGEST_FILE = 1_000_000_000


def write_checkpoint(path: Path, model: BaseAlgorithm, env: EpisodeVecEnv, run: dict[str, Any]) -> None:
    """Write weights, optimisers, random numbers and the number of the next episode; a replay buffer is left out."""
    _, places, position, spare, normal = np.random.get_state()  # noqa: NPY002
    state = {
        "run": run,
        "parts": model.get_parameters(),
        "extra": {name: getattr(model, name).data for name in _loose(model)},
        "torch": torch.get_rng_state(),
        "numpy": [torch.from_numpy(places.astype(np.int64)), int(position), int(spare), float(normal)],
        "actions": model.num_timesteps,
        "updates": model._n_updates,
        # the episode that the next batch begins with has been started
        "episode": env.next_episode - 1,
    }
    whole = io.BytesIO()
    torch.save(state, whole)
    write_whole(path, sealed(MARK, whole.getvalue()))


def read_checkpoint(path: Path) -> dict[str, Any]:
    """Read a checkpoint of write_checkpoint; tensors and plain values only, so that reading runs no code.

    Raises:
        InputError: for a file that is no checkpoint.
    """
    content = unsealed(MARK, read_whole(path, LARGEST_FILE, "delete it to start anew"))
    if content is None:
        raise InputError(f"{path} is no checkpoint, or a damaged one; delete it to start anew")
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # torch warns of a file that it did not write, and then refuses it
            found = torch.load(io.BytesIO(content), map_location="cpu", weights_only=True)
    except Exception as error:  # a forged file: torch lets through whatever its reader meets
        raise InputError(f"{path} is no checkpoint ({type(error).__name__}); delete it to start anew") from None
    if not (isinstance(found, dict) and {"run", "parts", "numpy", "episode"} <= found.keys()):
        raise InputError(f"{path} is no checkpoint; delete it to start anew")
    return found


def restore(state: dict[str, Any], model: BaseAlgorithm, env: EpisodeVecEnv) -> None:
    """Restore a model and its arms; random numbers are restored by restore_randomness, last of all."""
    model.set_parameters(state["parts"], exact_match=True, device="cpu")
    for name in _loose(model):
        getattr(model, name).data = state["extra"][name]
    model.num_timesteps, model._n_updates = state["actions"], state["updates"]
    env.next_episode = state["episode"]
    if isinstance(model, OffPolicyAlgorithm):
        # the replay buffer is empty: act until it holds as much as before the first update
        model.learning_starts += model.num_timesteps


def restore_randomness(state: dict[str, Any]) -> None:
    """Set the generators of torch and numpy, from which SB3 draws actions and batches."""
    places, position, spare, normal = state["numpy"]
    np.random.set_state(("MT19937", places.numpy().astype(np.uint32), position, spare, normal))  # noqa: NPY002
    torch.set_rng_state(state["torch"])


def _loose(model: BaseAlgorithm) -> list[str]:
    """List the tensors beside the model's networks."""
    return [name for name in model._get_torch_save_params()[1] if getattr(model, name, None) is not None]
