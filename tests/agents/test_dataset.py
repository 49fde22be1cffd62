"""Data sets for offline learning."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import gymnasium as gym
import numpy as np
import pytest

pytest.importorskip("stable_baselines3")

from agents import dataset
from flexarm_env.trials.sets import DEVELOPMENT_SEED


class Collector(gym.Wrapper):
    """Remembers what a collector of Minari stores."""

    def __init__(self, env: gym.Env, record_infos: bool) -> None:
        super().__init__(env)
        self.episodes: list[list[Any]] = []

    def reset(self, **given: Any) -> Any:
        self.episodes.append([])
        return self.env.reset(**given)

    def step(self, action: np.ndarray) -> Any:
        assert self.action_space.contains(action)
        self.episodes[-1].append(float(action[0]))
        return self.env.step(action)


@pytest.mark.parametrize("who", ["pd", "lqg", "policy", "random"])
def test_each_driver_drives_whole_episodes(who: str, monkeypatch: pytest.MonkeyPatch) -> None:
    make = gym.make
    monkeypatch.setattr(gym, "make", lambda id, **given: make(id, **given, duration=0.5))
    episodes = [dataset.collect(f"flexarm/damp/{who}-v0", 2, Collector).episodes for _ in range(2)]
    assert episodes[0] == episodes[1]  # the same each time
    first, second = episodes[0]
    assert (len(first), len(second)) == (100, 100)
    assert first != second
    assert np.ptp(first) > 0.01


def test_seeds_are_those_of_neither_training_nor_evaluation() -> None:
    assert 10_000_000 * 70 <= dataset.FIRST < DEVELOPMENT_SEED


def test_what_is_not_installed_is_named(capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(dataset, "missing", lambda: ["minari", "jax"])
    assert dataset.main([]) == 0
    assert "skipped 12 data sets: minari, jax not installed" in capsys.readouterr().err
    assert dataset.main(["flexarm/slew/pdd-v0"]) == 2
    assert "did you mean 'flexarm/slew/pd-v0'?" in capsys.readouterr().err


@pytest.mark.filterwarnings("default")  # it has warnings for itself
def test_minari_stores_a_data_set(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    for package in dataset.NEEDED:
        pytest.importorskip(package, reason=f"{package} is not installed: no data set")
    import minari

    monkeypatch.setenv("MINARI_DATASETS_PATH", str(tmp_path))
    for _ in range(2):
        assert dataset.main(["flexarm/damp/pd-v0", "--episodes", "2"]) == 0
    assert capsys.readouterr().out.splitlines()[-1] == "flexarm/damp/pd-v0: is there already"
    stored = minari.load_dataset("flexarm/damp/pd-v0")
    assert (stored.total_episodes, stored.total_steps) == (2, 2000)
    assert {"reward_vibration", "hub_angle"} <= stored[0].infos.keys()
    again = stored.recover_environment()
    assert np.array_equal(again.reset(seed=dataset.FIRST)[0], stored[0].observations[0])
