"""The independent simulator in the loop, and what is said of a corrected arm."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

pytest.importorskip("stable_baselines3")

from agents.goals import GOALS
from agents.rig import Machine, drive
from agents.rig_cases import CASES, Case, arm_files
from agents.rig_controllers import chosen, controllers_of, rehearse, tuned_place
from agents.rig_report import less_by, verdict_of
from agents.sim_to_rig import main, wanted
from flexarm_env import Arm
from flexarm_env.controllers import make_controller
from flexarm_env.controllers.tuned import TunedController
from flexarm_env.effects import catalogue
from flexarm_env.tasks import TASKS
from flexarm_env.trials.measures import MEASURES, measure
from flexarm_env.trials.rollout import roll_out
from flexarm_env.trials.score import cost
from flexarm_env.trials.sets import SETS
from tests.rig import simulate


def test_a_machine_driven_sample_by_sample_repeats_a_recording() -> None:
    commands = 3.0 * np.sin(np.arange(60) / 5.0)
    recorded = simulate({"dead": 0.3}, commands, 0, rate=200.0, step=2e-5)
    machine = Machine({"dead": 0.3}, 0, 60, 200.0)
    for k, command in enumerate(commands):
        angle, _, strain = machine.truth()
        assert angle == recorded["true_arm_angle"][k]
        assert strain == pytest.approx(recorded["true_strain_base"][k], rel=1e-12)
        machine.move(command)


@pytest.mark.parametrize("case", CASES.values(), ids=CASES)
def test_the_machine_does_what_the_nominal_arm_does_where_nothing_is_hidden(case: Case) -> None:
    arm, task = Arm.load(case.nominal), TASKS["slew"]
    controller = make_controller("pd", arm, 0.005)
    machine = measure(drive(controller, task, case.known, 2, signals=tuple(arm.signals)), task)
    model = measure(roll_out(controller, task, arm, SETS["nominal"], 2), task)
    assert machine["steady_error"] == pytest.approx(model["steady_error"], rel=0.05)
    assert machine["residual_strain"] == pytest.approx(model["residual_strain"], rel=0.2)


def test_an_agent_observes_only_what_its_machine_measures() -> None:
    every, few = Machine({}, 0, 3, 200.0), Machine({}, 0, 3, 200.0, ("strain_base", "arm_angle"))
    for machine in (every, few):
        machine.move(3.0)
        machine.move(3.0)
    angle, *_, strain = every.readings()
    assert 0.0 != strain != angle != 0.0
    assert few.readings().tolist() == [strain, angle]


def test_what_is_hidden_is_in_the_catalogue_and_not_in_the_nominal_arm() -> None:
    for case in CASES.values():
        assert case.effect in catalogue()
        assert case.effect not in Arm.load(case.nominal).effects
        assert case.settings != case.known


def test_the_corrected_arm_s_policies_are_trained_as_the_nominal_one_s(tmp_path) -> None:
    plans = {name.name: plan.table() for name, plan in wanted(tmp_path).items()}
    nominal = {case.nominal.stem for case in CASES.values()}
    kinds = {f"{kind}-{arm}" for kind in ("nominal", "randomised") for arm in nominal}
    assert set(plans) == {*kinds, *(f"corrected-{case}" for case in CASES)}
    for name, case in CASES.items():
        corrected, given = plans[f"corrected-{name}"], plans[f"nominal-{case.nominal.stem}"]
        assert corrected.pop("arm").endswith(f"arms/{name}.toml")
        assert Arm.load(given["arm"]) == Arm.load(case.nominal)
        assert corrected == {key: value for key, value in given.items() if key != "arm"}


def test_each_law_is_made_and_tuned_for_both_arms(tmp_path) -> None:
    (tmp_path / "arms").mkdir()
    Arm.load("thesis-fem").with_effect("constant_torque", torque=0.1).save(tmp_path / "arms" / "bias.toml")
    for arm, gain in zip(arm_files("bias", tmp_path).values(), (2.0, 6.0), strict=True):
        place = tuned_place(tmp_path, "pd", arm)
        place.parent.mkdir(exist_ok=True)
        TunedController("pd", arm.stem, "0.1.0", {"proportional": gain}).save(place)
    found = controllers_of(tmp_path, "bias")
    assert {"pd, nominal", "pd, corrected", "lqg, corrected", "pd tuned, nominal", "pd tuned, corrected"} <= set(found)
    assert "lqg tuned, corrected" not in found  # not made
    nominal, corrected = (
        make_controller(str(law), arm, 0.005) for law, arm in (found["pd tuned, nominal"], found["pd tuned, corrected"])
    )
    assert (nominal.proportional, corrected.proportional) == (2.0, 6.0)
    assert nominal.loads.torque == 0.0 != corrected.loads.torque


def test_a_law_against_vibration_is_left_out_for_a_rigid_link(tmp_path) -> None:
    (tmp_path / "arms").mkdir()
    Arm.load(CASES["soft-gears"].nominal).save(tmp_path / "arms" / "soft-gears.toml")
    assert {name.partition(",")[0] for name in controllers_of(tmp_path, "soft-gears")} == {"pd", "lqg"}


def test_of_two_controllers_the_one_is_chosen_that_a_simulation_of_the_arm_shows_to_be_better(tmp_path) -> None:
    arm, found = Arm.load("thesis-fem"), {}
    for kind, gain in (("weak", 0.5), ("strong", 12.0)):
        TunedController("pd", "thesis-fem", "0.1.0", {"proportional": gain}).save(tmp_path / f"{kind}.toml")
        found[kind] = rehearse(tmp_path / f"{kind}.toml", arm, arm)
    weak, strong = found["weak"], found["strong"]
    assert chosen({"pd, nominal": weak, "pd, corrected": strong}) == {"pd": "corrected"}
    assert chosen({"pd, nominal": strong, "pd, corrected": weak}) == {"pd": "nominal"}
    assert chosen({"pd, nominal": weak, "pd, corrected": weak, "lqg, corrected": weak}) == {"pd": "nominal"}


def test_the_cost_is_the_logarithm_of_the_geometric_mean() -> None:
    values = dict(zip(GOALS, (np.full((1, 4), size) for size in (2.0, 0.5, 0.01)), strict=True))
    assert np.exp(cost(values)) == pytest.approx(np.full((1, 4), (2.0 * 0.5 * 0.01) ** (1 / 3)))
    half = {name: 0.5 * value for name, value in values.items()}
    assert less_by(half, values) == pytest.approx((0.5, 0.5, 0.5))


def test_the_strain_that_a_rigid_link_lacks_does_not_dilute_the_cost() -> None:
    values = {"settling_time": np.full((1, 4), 2.0), "steady_error": np.full((1, 4), 0.5), "residual_strain": np.zeros((1, 4))}
    assert np.exp(cost(values)) == pytest.approx(np.ones((1, 4)))
    half = {name: 0.5 * value for name, value in values.items()}
    assert less_by(half, values) == pytest.approx((0.5, 0.5, 0.5))


def test_a_gain_that_only_one_run_of_three_shows_is_not_sure() -> None:
    other = {name: np.ones((3, 10)) for name in MEASURES}
    own = {name: np.repeat([[0.1], [1.05], [1.05]], 10, axis=1) for name in MEASURES}
    value, low, high = less_by(own, other)
    assert low < 0.0 < value < high
    found = verdict_of({"policy, nominal": other, "policy, corrected": own})
    assert found["corrected_less_by"]["policy"]["nominal"]["low"] < 0.0


def test_without_policies_the_command_says_what_to_do(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["--save", str(tmp_path)]) == 2
    error = capsys.readouterr().err
    assert "--make" in error
    assert error.count("\n") == 1
