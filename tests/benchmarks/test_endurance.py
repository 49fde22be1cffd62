"""The endurance of the environments, and a run that reports what breaks it."""

from __future__ import annotations

import itertools
import json
from types import SimpleNamespace

import gymnasium as gym
import numpy as np
import pytest

from benchmarks.endurance import __main__ as endurance
from benchmarks.endurance import table
from benchmarks.endurance.actions import KINDS, actions, block
from benchmarks.endurance.measure import endure
from benchmarks.endurance.parts import ARMS, LONGEST_PART, Part, parts_of
from flexarm_env.registration import IDS, SHAPED

CALLS = 50
PART = Part("FlexArm/Slew-v0", True, 0, CALLS, 1)


class Arms:
    """Arms that take 1 ms for a call, but 2 s for the first; one call may take longer, or return a number that is not finite."""

    def __init__(self, slow: int = -1, odd: int = -1, what: str = "", value: float = np.nan) -> None:
        self.slow, self.odd, self.what, self.value = slow, odd, what, value
        self.now, self.calls = 0.0, 0
        self.action_space = gym.spaces.Box(-1.0, 1.0, (ARMS, 1), np.float32)
        self.batch = SimpleNamespace(states=np.zeros((ARMS, 4)))

    def reset(self, seed: int) -> None:
        self.calls = 0

    def step(self, action):
        self.now += {0: 2.0, self.slow: 1.5}.get(self.calls, 0.001)
        made = {"observations": np.zeros((ARMS, 5), np.float32), "rewards": np.zeros(ARMS), "states": self.batch.states}
        if self.calls == self.odd:
            made[self.what].reshape(-1)[7] = self.value
        self.calls += 1
        over = np.arange(ARMS) == 3
        return made["observations"], made["rewards"], over, np.zeros(ARMS, bool), {}


def result_of(arms: Arms) -> dict:
    outcome = PART.as_json() | endure(PART, arms, clock=lambda: arms.now).as_json()
    return {"seed": 1, "command": "it", "version": "1", "commit": None} | table.record([outcome], "")


def test_a_sound_environment_keeps_the_promise():
    result = result_of(Arms())
    assert table.kept(result)
    assert (result["steps"], result["episodes"], result["slowest_over_median"]) == (CALLS * ARMS, CALLS, 1.0)


@pytest.mark.parametrize("what", ["observations", "rewards", "states"])
@pytest.mark.parametrize("value", [np.nan, np.inf, -np.inf])
def test_a_number_that_is_not_finite_is_reported(what, value):
    result = result_of(Arms(odd=20, what=what, value=value))
    assert not table.kept(result)
    assert result["not_finite"] == [f"FlexArm/Slew-v0: call 20: {what}"]
    assert result["steps"] == 20 * ARMS  # those after it are not claimed
    assert f"not finite: FlexArm/Slew-v0: call 20: {what}" in table.markdown(result)


def test_a_call_that_stalls_is_reported():
    result = result_of(Arms(slow=30))
    assert not table.kept(result)
    assert result["slowest_over_median"] == pytest.approx(1500.0)
    (case,) = result["environments"]
    assert (case["slowest_ms"], case["median_ms"]) == (1500.0, 1.0)
    assert case["slowest_cpu_ms"] < 1500.0  # it did not work, it waited
    assert "1500 times the median one" in table.markdown(result)


def test_a_call_that_never_returns_is_reported(tmp_path, monkeypatch):
    def wait(*_: object) -> None:
        import time

        time.sleep(60.0)

    monkeypatch.setattr(endurance, "_outcome", wait)
    monkeypatch.setattr(endurance, "LONGEST", 0.5)
    assert endurance.measured(parts_of(100_000, 1)[:2], tmp_path, 2, {}) == ([], "Damp-v0-undisturbed-000")


def test_a_run_with_a_hung_part_breaks_the_promise():
    outcome = PART.as_json() | endure(PART, Arms()).as_json()
    assert not table.kept(table.record([outcome], PART.name))


def test_every_environment_endures(tmp_path):
    assert endurance.main(["--steps", "10000", "--jobs", "1", "--out", str(tmp_path)]) == 0
    result = json.loads((tmp_path / "endurance.json").read_text())
    assert {case["id"] for case in result["environments"]} == {*IDS, *SHAPED}
    assert sum(case["steps"] for case in result["environments"] if case["disturbed"]) * 2 == result["steps"] >= 10_000
    assert (tmp_path / "endurance.md").read_text() == table.markdown(result)


def test_a_stopped_run_goes_on(tmp_path, monkeypatch, capsys):
    taken = []

    def few(part, envs):
        taken.append(part)
        if len(taken) == 4:
            raise KeyboardInterrupt
        return endure(part, Arms())

    monkeypatch.setattr(Part, "make", lambda part: SimpleNamespace(close=lambda: None))
    monkeypatch.setattr(endurance, "endure", few)
    arguments = ["--steps", "10000", "--jobs", "1", "--out", str(tmp_path)]
    assert endurance.main(arguments) == 130
    assert capsys.readouterr().err.endswith("stopped; the same command goes on\n")
    assert endurance.main(arguments) == 0
    parts = parts_of(10_000, 1)
    assert taken == parts[:4] + parts[3:]
    assert endurance.main([*arguments, "--seed", "2"]) == 0
    assert len(taken) == len(parts) + 1 + len(parts)  # outcomes of another seed are not taken for its own


def test_parts_share_the_steps_equally():
    parts = parts_of(100_000_000, 1)
    by_case = {}
    for part in parts:
        by_case[part.id, part.disturbed] = by_case.get((part.id, part.disturbed), 0) + part.steps
    assert len(by_case) == 2 * len({*IDS, *SHAPED})
    assert len(set(by_case.values())) == 1
    assert 0 <= sum(by_case.values()) - 100_000_000 < len(by_case) * ARMS
    assert max(part.calls for part in parts) == LONGEST_PART
    assert len({part.name for part in parts}) == len(parts)
    assert len({part.seeds().generate_state(1)[0] for part in parts}) == len(parts)


def test_actions_hold_all_extremes():
    drawn = block(np.random.default_rng(1), (40 * KINDS, 1))[:, :, 0]
    steady = np.ptp(drawn, axis=0) == 0.0
    assert {-1.0, 0.0, 1.0} < set(drawn[0, steady])
    at_ends = np.all(np.abs(drawn) == 1.0, axis=0)
    turns = at_ends & np.all(drawn[1:] == -drawn[:-1], axis=0)
    assert 0 < turns.sum() < (at_ends & ~steady).sum()
    assert 1e5 < np.abs(drawn).max() <= 1e6
    assert drawn.dtype == np.float32


def test_actions_are_those_of_the_seed_for_each_call():
    first, again = (list(actions(np.random.default_rng(3), 450, (2, 2))) for _ in range(2))
    assert len(first) == 450
    assert all(np.array_equal(a, b) for a, b in zip(first, again, strict=True))
    assert not any(np.array_equal(a, b) for a, b in itertools.pairwise(first))


@pytest.mark.parametrize("arguments", [["--steps", "0"], ["--jobs", "0"], ["--seed", "-1"]])
def test_impossible_requests_are_refused(arguments, capsys):
    with pytest.raises(SystemExit, match="2"):
        endurance.main(arguments)
    assert f"{arguments[0]} {arguments[1]}: " in capsys.readouterr().err
