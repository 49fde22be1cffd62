"""Plans, what a policy sees, artefacts and runs that are stopped."""

from __future__ import annotations

import json
import pickle
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest

pytest.importorskip("stable_baselines3")
import torch
from safetensors.torch import load_file, save_file

from agents.learning.artefact import Artefact
from agents.learning.episodes import RATE, EpisodeVecEnv
from agents.learning.interface import PolicyInterface
from agents.learning.models import make_model
from agents.learning.options import ALGORITHMS, InterfaceOptions, Plan, RewardOptions
from agents.learning.plan_file import option_table, read_plan, read_table
from agents.learning.reward import TrainingReward
from agents.learning.run import train
from agents.measures import measure
from agents.rollout import roll_out
from agents.sets import SETS
from agents.train import main
from flexarm_env import Arm, InputError
from flexarm_env.controllers import make_controller
from flexarm_env.tasks import TASKS

CONFIGS = sorted((Path(__file__).parents[2] / "configs" / "agents").glob("*.toml"))
SMALL = {
    "at_once": 2,
    "actions": 40,
    "network": {"layers": [8], "memory": 4},
    "learning": {"batch_size": 20, "epochs": 2, "warm_up": 10, "gradient_steps": 1, "buffer": 200},
    "interface": {"repeat": 100, "lags": [0, 3], "averages": [0.05]},
}


def small(**changes: object) -> Plan:
    return read_table({**SMALL, **changes})


def silent(share: float, text: str) -> None:
    pass


@pytest.mark.parametrize("path", CONFIGS, ids=lambda path: path.stem)
def test_every_shipped_configuration_is_read(path: Path) -> None:
    plan = read_plan(path)
    assert read_table(json.loads(json.dumps(plan.table()))) == plan
    if plan.algorithm == "ppo":
        steps = TASKS[plan.task].duration * RATE // plan.interface.repeat
        assert steps * plan.at_once % plan.learning.batch_size == 0


@pytest.mark.parametrize(
    ("table", "words"),
    [
        ({"algoritm": "ppo"}, "unknown key 'algoritm'; did you mean 'algorithm'?"),
        ({"learning": {"gama": 0.9}}, "unknown key 'learning.gama'; did you mean 'gamma'?"),
        ({"algorithm": "pp"}, "did you mean 'ppo'?"),
        ({"learning": {"gamma": 1.5}}, "learning.gamma = 1.5; allowed are 0 to 1"),
        ({"learning": {"gamma": "high"}}, "give a number"),
        ({"at_once": 2.5}, "give a whole number"),
        ({"interface": {"lags": 3}}, "give a list"),
        ({"interface": {"estimate": 1}}, "give true or false"),
        ({"interface": {"base": "lgq"}}, "did you mean 'lqg'?"),
        ({"reward": 3}, "write [reward]"),
    ],
)
def test_a_wrong_option_is_named_in_one_line(table: dict, words: str) -> None:
    with pytest.raises(InputError) as error:
        read_table(table)
    assert words in str(error.value)
    assert "\n" not in str(error.value)


def test_every_option_is_documented(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["--options"]) == 0
    shown = capsys.readouterr().out
    assert shown == option_table()
    for section, entries in Plan().table().items():
        for name in entries if isinstance(entries, dict) else [section]:
            assert f"{name}`" in shown


@pytest.mark.parametrize(("name", "text", "word"), [("a.toml", "x = [", "TOML"), ("b.toml", "steps = 3\n", "steps")])
def test_the_command_refuses_a_bad_file_in_one_line(
    name: str, text: str, word: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / name).write_text(text)
    assert main([str(tmp_path / name)]) == 2
    error = capsys.readouterr().err
    assert word in error
    assert error.count("\n") == 1


def test_an_action_of_nothing_leaves_the_base_controller_alone() -> None:
    arm = Arm.load("thesis")
    interface = PolicyInterface(InterfaceOptions(base="lqg", authority=0.3), arm, 1.0 / RATE)

    class Idle:
        def reset(self, count: int | None = None) -> None:
            interface.start(count or 1)

        def action(self, observation: np.ndarray) -> np.ndarray:
            interface.see(observation)
            return interface.send(np.zeros((interface.count, 1)))

    alone = roll_out(make_controller("lqg", arm, 1.0 / RATE), TASKS["slew"], arm, SETS["randomised"], 3)
    assert np.array_equal(roll_out(Idle(), TASKS["slew"], arm, SETS["randomised"], 3).tip, alone.tip)


def test_a_base_controller_knows_what_the_policy_adds() -> None:
    """Under the same commands in all, the filter of an LQG with something added agrees with a filter of its own."""
    arm = Arm.load("thesis")
    interface = PolicyInterface(InterfaceOptions(base="lqg", authority=0.3), arm, 1.0 / RATE)
    draw = np.random.default_rng(0)
    interface.start(2)
    for _ in range(50):
        interface.see(draw.normal(size=(2, 5)) * [1.0, 1.0, 0.1, 0.1, 0.0])
        interface.send(draw.uniform(-1.0, 1.0, (2, 1)))
    assert interface.base is not None
    assert np.allclose(interface.base.estimator.state, interface.estimator.state, rtol=1e-9, atol=1e-9)


def test_lags_show_what_was_read_that_many_samples_ago() -> None:
    arm = Arm.load("thesis")
    options = InterfaceOptions(lags=(0, 2), command_lags=(1,), estimate=False)
    interface = PolicyInterface(options, arm, 1.0 / RATE)
    interface.start(1)
    shown = []
    for k in range(5):
        interface.see(np.array([[0.01 * k, 0.0, 0.0, 0.0, 0.0]]))
        shown.append(interface.features()[0])
        interface.send(np.array([[0.1 * k]]))
    assert shown[4][4] == shown[2][0]
    assert shown[4][-1] == pytest.approx(0.2)


def test_only_the_critic_sees_the_truth() -> None:
    plan = small()
    env = EpisodeVecEnv(plan, Arm.load("thesis"), 0)
    model = make_model(plan, env, 0)
    seen = torch.as_tensor(env.reset())
    other = seen.clone()
    other[:, env.interface.size :] += 1.0
    policy = model.policy
    assert torch.equal(policy.get_distribution(seen).mode(), policy.get_distribution(other).mode())
    assert not torch.equal(policy.predict_values(seen), policy.predict_values(other))


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


def test_loading_runs_no_code(tmp_path: Path) -> None:
    class Harm:
        def __reduce__(self) -> tuple:
            return (Path.touch, (tmp_path / "harmed",))

    (tmp_path / "bad-0.safetensors").write_bytes(pickle.dumps(Harm()))
    (tmp_path / "bad-0.checkpoint").write_bytes(pickle.dumps({"run": Harm()}))
    with pytest.raises(InputError, match="no policy"):
        Artefact.load(tmp_path / "bad-0.safetensors")
    with pytest.raises(InputError, match="no checkpoint"):
        train(small(), 0, tmp_path / "bad-0.checkpoint", silent)
    assert not (tmp_path / "harmed").exists()


def test_weights_that_do_not_fit_are_refused(tmp_path: Path) -> None:
    path = tmp_path / "a-0.safetensors"
    made = train(small(), 0, None, silent)
    replace(made, plan=replace(made.plan, network=replace(made.plan.network, layers=(9,)))).save(path)
    with pytest.raises(InputError, match="do not fit"):
        Artefact.load(path).agent()
    save_file(load_file(path), path)
    with pytest.raises(InputError, match="holds no policy"):
        Artefact.load(path)


class Stop(Exception):
    pass


@pytest.mark.parametrize("algorithm", ["ppo", "recurrent_ppo"])
def test_a_stopped_run_ends_with_the_same_bits(algorithm: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("agents.learning.run.BETWEEN", 0.0)
    plan = small(algorithm=algorithm, actions=100)
    whole = train(plan, 3, None, silent)

    def stop(share: float, text: str) -> None:
        if share >= 0.6:
            raise Stop

    with pytest.raises(Stop):
        train(plan, 3, tmp_path / "a.checkpoint", stop)
    resumed = train(plan, 3, tmp_path / "a.checkpoint", silent)
    assert resumed.weights.keys() == whole.weights.keys()
    for name, value in whole.weights.items():
        assert torch.equal(value, resumed.weights[name]), name
    assert resumed.run["curve"] == whole.run["curve"]


@pytest.mark.parametrize("algorithm", ["sac", "tqc"])
def test_an_off_policy_run_goes_on(algorithm: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("agents.learning.run.BETWEEN", 0.0)
    plan = small(algorithm=algorithm, actions=100)

    def stop(share: float, text: str) -> None:
        if share >= 0.6:
            raise Stop

    with pytest.raises(Stop):
        train(plan, 3, tmp_path / "a.checkpoint", stop)
    assert train(plan, 3, tmp_path / "a.checkpoint", silent).run["actions"] >= 100


def test_a_checkpoint_of_another_plan_is_refused(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("agents.learning.run.BETWEEN", 0.0)
    train(small(actions=60), 3, tmp_path / "a.checkpoint", silent)
    with pytest.raises(InputError, match="another plan"):
        train(small(actions=80), 3, tmp_path / "a.checkpoint", silent)


def test_the_command_trains_what_is_not_there(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    config = tmp_path / "tiny.toml"
    config.write_text(
        "actions = 20\nat_once = 2\n[network]\nlayers = [4]\n[learning]\nbatch_size = 20\n[interface]\nrepeat = 100\n"
    )
    command = [str(config), "--seeds", "0", "--save", str(tmp_path / "made"), "--tensorboard", str(tmp_path / "board")]
    assert main(command) == 0
    assert main(command) == 0
    assert "is there already" in capsys.readouterr().out
    assert [path.name for path in (tmp_path / "made").iterdir()] == ["tiny-0.safetensors"]
    assert any((tmp_path / "board").rglob("events.*"))


def test_actions_that_are_to_stray_less_do() -> None:
    network = {"layers": [8], "spread": "falling", "log_std": -1.0, "last_log_std": -3.0}
    made = train(small(network=network), 0, None, silent)
    assert made.weights["log_std"].item() == pytest.approx(-2.0)  # set at the start of the second of two batches
    assert train(small(network=network | {"spread": "own"}), 0, None, silent).weights["spread_net.weight"].shape == (1, 8)


def test_a_pulse_is_sent_in_the_first_sample_that_an_action_is_held_for() -> None:
    interface = PolicyInterface(InterfaceOptions(authority=0.1, pulse=0.3, repeat=3), Arm.load("thesis"), 1.0 / RATE)
    interface.start(2)
    action = np.array([[0.5, 1.0], [-1.0, -0.5]])
    sent = []
    for _ in range(4):
        interface.see(np.zeros((2, 5)))
        sent.append(interface.send(action)[:, 0])
    pulse, held = [0.05 + 0.3, -0.1 - 0.15], [0.05, -0.1]
    np.testing.assert_allclose(sent, [pulse, held, held, pulse], rtol=1e-6)


@pytest.mark.parametrize("algorithm", ["ppo", "sac"])
def test_a_policy_with_pulses_is_trained_and_reloads(tmp_path: Path, algorithm: str) -> None:
    interface = {"base": "pd", "pulse": 0.3, "repeat": 100}
    made = train(small(algorithm=algorithm, interface=interface, network={"layers": [8], "spread": "own"}), 0, None, silent)
    made.save(tmp_path / "pulses-0.safetensors")
    agent, reading = Artefact.load(tmp_path / "pulses-0.safetensors").agent(), np.zeros((3, 5))
    agent.reset(3)
    assert agent.action(reading).shape == (3, 1)
    assert agent.held.shape == (3, 2)


def test_the_documentation_lists_every_option() -> None:
    document = (Path(__file__).parents[2] / "docs" / "policies.md").read_text(encoding="utf-8")
    written = document.split("<!-- options -->\n")[1].split("<!-- /options -->")[0]
    assert written == option_table(), "docs/policies.md has other options than: python -m agents.train --options"


def test_vibration_weighs_more_as_training_goes_on() -> None:
    env = EpisodeVecEnv(small(actions=80, reward={"vibration": 0.5, "rise": 3.0}), Arm.load("thesis"), 0)
    weights = []
    for _ in range(3):
        env.reset()
        weights.append(env.reward.vibration)
    assert weights == [0.5, 0.75, 1.0]  # 20 actions in each batch of episodes


def vibration_costs(frequency: float, amplitude: float) -> np.ndarray:
    """Rewards of 400 samples in which nothing is wrong but the base strain."""
    arm = Arm.load("thesis")
    nothing = {name: np.zeros(1) for name in ("hub_angle", "tip_deflection", "target")}
    batch = SimpleNamespace(looks=np.zeros((1, 4)), info=lambda: nothing)
    envs = SimpleNamespace(batch=batch, num_envs=1, setup=SimpleNamespace(arm=arm, rate=RATE))
    reward, gage = TrainingReward(RewardOptions(), envs), list(arm.signals).index("strain_base")  # type: ignore[arg-type]
    reward.start(0.0)
    costs = []
    for k in range(1, 401):
        batch.looks[0, gage] = amplitude * np.sin(2.0 * np.pi * frequency * k / RATE)
        costs.append(-reward.sample()[0])
    return np.array(costs[100:])


def test_the_cost_of_vibration_is_that_of_its_amplitude() -> None:
    costs, scale, weight = vibration_costs(2.0, 0.03), 0.01, 0.5
    np.testing.assert_allclose(costs, weight * np.log1p(0.03 / scale) / np.log1p(3.0 / scale), rtol=1e-9)
    # a vibration ten times as fast costs no more, though its rate is ten times as large
    assert vibration_costs(24.0, 0.03).mean() < costs.mean()
