"""Policies as files."""

from __future__ import annotations

import io
import json
import math
import pickle
import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

pytest.importorskip("stable_baselines3")
import torch
from safetensors import safe_open
from safetensors.torch import load_file, save_file
from small_plans import silent, small

from agents.learning import artefact
from agents.learning.artefact import Artefact, acting_weights
from agents.learning.checkpoint import MARK
from agents.learning.models import bare_policy, hidden_weights
from agents.learning.options import ALGORITHMS, MOST_LAYERS
from agents.learning.run import train
from agents.seal import sealed
from flexarm_env import Arm, InputError
from flexarm_env.tasks import TASKS
from flexarm_env.trials.measures import measure
from flexarm_env.trials.rollout import roll_out
from flexarm_env.trials.sets import SETS


@pytest.mark.parametrize("algorithm", ALGORITHMS)
def test_an_artefact_reloads_to_the_same_scores(algorithm: str, tmp_path: Path) -> None:
    made = train(small(algorithm=algorithm), 1, None, silent)
    made.save(tmp_path / "a-1.safetensors")
    loaded = Artefact.load(tmp_path / "a-1.safetensors")
    assert loaded.plan == made.plan
    assert loaded.run == made.run
    arm = Arm.load("thesis")
    scores = [
        measure(roll_out(which.agent(), TASKS["slew"], arm, SETS["randomised"], 2), TASKS["slew"]) for which in (made, loaded)
    ]
    for name in scores[0]:
        assert np.array_equal(scores[0][name], scores[1][name])


def test_one_arm_is_driven_as_among_many() -> None:
    agent = train(small(), 1, None, silent).agent()
    seen = np.array([0.1, 0.2, 0.0, 0.1, 1.7])
    agent.reset()
    alone = agent.action(seen)
    agent.reset(1)
    assert alone.shape == (1,)
    assert np.array_equal(agent.action(seen[None])[0], alone)


@pytest.mark.parametrize("algorithm", ["ppo", "sac"])
def test_a_policy_with_pulses_is_trained_and_reloads(tmp_path: Path, algorithm: str) -> None:
    interface = {"base": "pd", "pulse": 0.3, "repeat": 100}
    made = train(small(algorithm=algorithm, interface=interface, network={"layers": [8], "spread": "own"}), 0, None, silent)
    made.save(tmp_path / "pulses-0.safetensors")
    agent, reading = Artefact.load(tmp_path / "pulses-0.safetensors").agent(), np.zeros((3, 5))
    agent.reset(3)
    assert agent.action(reading).shape == (3, 1)
    assert agent.held.shape == (3, 2)


def test_loading_runs_no_code(tmp_path: Path) -> None:
    class Harm:
        def __reduce__(self) -> tuple:
            return (Path.touch, (tmp_path / "harmed",))

    (tmp_path / "bad-0.safetensors").write_bytes(pickle.dumps(Harm()))
    with pytest.raises(InputError, match="no policy"):
        Artefact.load(tmp_path / "bad-0.safetensors")
    forged = io.BytesIO()
    torch.save({"run": Harm()}, forged)
    harmful = pickle.dumps({"run": Harm()})
    for content in (harmful, sealed(MARK, harmful), sealed(MARK, forged.getvalue())):
        (tmp_path / "bad-0.checkpoint").write_bytes(content)
        with pytest.raises(InputError, match="no checkpoint"):
            train(small(), 0, tmp_path / "bad-0.checkpoint", silent)
    assert not (tmp_path / "harmed").exists()


def test_weights_that_do_not_fit_are_refused(tmp_path: Path) -> None:
    path = tmp_path / "a-0.safetensors"
    made = train(small(), 0, None, silent)
    replace(made, plan=replace(made.plan, network=replace(made.plan.network, layers=(9,)))).save(path)
    with pytest.raises(InputError, match=r"a-0\.safetensors: the weights do not fit the plan"):
        Artefact.load(path).agent()
    save_file(load_file(path), path)
    with pytest.raises(InputError, match="holds no policy"):
        Artefact.load(path)


@pytest.mark.parametrize("algorithm", ALGORITHMS)
def test_no_network_is_built_for_a_plan_that_the_weights_cannot_fill(monkeypatch: pytest.MonkeyPatch, algorithm: str) -> None:
    made = train(small(algorithm=algorithm), 0, None, silent)
    network = replace(made.plan.network, layers=MOST_LAYERS * (4096,), memory=4096)
    monkeypatch.setattr(artefact, "bare_policy", lambda *_: pytest.fail("a network of gigabytes is built"))
    with pytest.raises(InputError, match=r"the weights do not fit the plan: its layers have \d{9} weights, and \d+ are there"):
        replace(made, plan=replace(made.plan, network=network)).agent()


@pytest.mark.parametrize("algorithm", ALGORITHMS)
@pytest.mark.parametrize("layers", [[], [8], [8, 5, 3]])
def test_the_weights_of_a_plan_are_counted_as_they_are_built(algorithm: str, layers: list[int]) -> None:
    plan, visible, last = small(algorithm=algorithm, network={"layers": layers, "memory": 4}), 7, "action_net."
    if algorithm in ("sac", "tqc"):
        last = "actor.mu."
    weights = acting_weights(bare_policy(plan, visible))
    loose = ("log_std", last, "actor.log_std.")
    assert hidden_weights(plan, visible) == sum(each.numel() for name, each in weights.items() if not name.startswith(loose))


@pytest.fixture(scope="module")
def trained() -> Artefact:
    return train(small(), 0, None, silent)


@pytest.mark.parametrize("value", [math.nan, math.inf, True, 1j])
def test_weights_that_are_no_finite_numbers_are_refused(trained: Artefact, tmp_path: Path, value: complex) -> None:
    path = tmp_path / "a-0.safetensors"
    whole = dict(trained.weights)
    name = next(iter(whole))
    replace(trained, weights=whole | {name: torch.full(whole[name].shape, value)}).save(path)
    with pytest.raises(InputError, match=f"a-0\\.safetensors: weights '{re.escape(name)}' are not all finite real numbers"):
        Artefact.load(path)


def test_weights_of_a_kind_that_torch_computes_nothing_of_are_refused(trained: Artefact, tmp_path: Path) -> None:
    path = tmp_path / "a-0.safetensors"
    replace(trained, weights={name: value.to(torch.float8_e4m3fn) for name, value in trained.weights.items()}).save(path)
    with pytest.raises(InputError, match=r"a-0\.safetensors is no policy \(.*; python -m agents.train makes one") as caught:
        Artefact.load(path)
    assert str(caught.value).isprintable()


@pytest.mark.parametrize(
    ("entry", "text", "words"),
    [
        ("run", "null", "run = None is no table"),
        ("run", "[]", "run = [] is no table"),
        ("run", "{}", "run.seed is missing"),
        ("seed", "-1", "run.seed is missing, or of another kind"),
        ("version", "3", "run.version"),
        ("actions", "true", "run.actions"),
        ("seconds", "NaN", "run.seconds"),
        ("seconds", "1" + 400 * "0", "run.seconds"),
        ("curve", "[[1, 2], [3]]", "run.curve"),
        ("curve", "[[1, Infinity]]", "run.curve"),
        ("plan", '{"actions": 1' + 400 * "0" + "}", "actions = inf; allowed are "),
        ("plan", "[]", "the options = [] is not a table; give some of algorithm, task"),
        ("plan", '{"x": 1}', "unknown key 'x'; allowed: actions"),
        ("plan", '{"seeds": 0}', "seeds = 0"),
        ("plan", json.dumps({"network": {"layers": 200 * [4096]}}), "network.layers has 200 entries; give 16 at most"),
        ("plan", json.dumps({"interface": {"lags": 5000 * [0]}}), "interface.lags has 5000 entries; give 2001 at most"),
        ("arm", "x = 1", "unknown key 'x'"),
        ("arm", "x", "its arm: is not TOML: "),
        ("arm", 20_000 * "a." + "a = 1", "its arm: is not TOML that can be read"),
        ("arm", "a = " + 5_000 * "[" + 5_000 * "]", "its arm: is not TOML that can be read"),
        ("arm", 2_000_000 * "#", "its arm: is longer than "),
        ("format", "other", "holds no policy of format"),
    ],
)
def test_a_policy_with_other_texts_is_refused_by_its_file(
    trained: Artefact, tmp_path: Path, entry: str, text: str, words: str
) -> None:
    path = tmp_path / "a-0.safetensors"
    trained.save(path)
    with safe_open(path, "pt") as file:
        texts = file.metadata()
    if entry in texts:
        texts[entry] = text
    else:
        texts["run"] = json.dumps(json.loads(texts["run"]) | {entry: "…"}).replace('"\\u2026"', text)
    save_file(load_file(path), path, texts)
    with pytest.raises(InputError) as caught:
        Artefact.load(path)
    assert str(caught.value).startswith(f"{path}: ")
    assert words in str(caught.value)
    assert str(caught.value).isprintable()
