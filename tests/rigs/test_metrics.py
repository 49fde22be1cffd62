"""The figures of rigs: against independent code in numpy, on the published recordings."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from emps_recipe import published, published_errors, relative_error
from scipy.signal import butter, filtfilt

from flexarm_env import Arm, Recording, simulate
from flexarm_env.errors import InputError
from flexarm_env.rigs.inverse import Recipe
from flexarm_env.rigs.metric import AngleError, CommandError, SignalFit
from flexarm_env.rigs.table import RIGS

EMPS, UR10E = (next(rig for rig in RIGS if rig.name == name) for name in ("emps", "ur10e"))


def emps(constants: dict[str, float]) -> Arm:
    """The arm with constants by the names of the published recipe."""
    two = {"Fv": constants.get("Fv", 0.0), "Fc": constants.get("Fc", 0.0), "offset": constants.get("offset", 0.0)}
    half = 0.0
    if "Fv+" in constants:
        two = {"Fv": (constants["Fv+"] + constants["Fv-"]) / 2, "Fc": (constants["Fc+"] + constants["Fc-"]) / 2}
        two["offset"] = (constants["Fc+"] - constants["Fc-"]) / 2
        half = (constants["Fv+"] - constants["Fv-"]) / 2
    arm = Arm.load("emps").with_values({"hub.inertia": constants["M"]})
    arm = arm.with_effect("viscous", coefficient=two["Fv"]).with_effect("coulomb", torque=two["Fc"])
    arm = arm.with_effect("constant_torque", torque=-two["offset"])
    return arm.with_effect("asymmetric_viscous", coefficient=half) if half else arm


@pytest.mark.parametrize("model", list(published))
def test_the_force_error_of_emps_is_that_of_the_published_recipe(measurements, model):
    arm = emps(published[model])
    records = (EMPS.training[0], EMPS.held_out[0])
    for record, printed in zip(records, published_errors[model], strict=True):
        ours = EMPS.metric.of(arm, [record.read(measurements, arm)])
        theirs = relative_error(measurements / record.file, published[model])
        assert ours == pytest.approx(theirs, abs=0.001)  # which counts rest as backward motion, at exactly 1 kHz
        assert ours == pytest.approx(printed, abs=0.005)


def test_the_current_error_of_ur10e_is_that_of_a_regression(measurements):
    """Constants by least squares on smoothed derivatives; the rms errors of their publisher in passing."""
    raw = np.loadtxt(measurements / UR10E.training[0].file, delimiter=",")
    time, speed, current = raw[:, 0], raw[:, 7], raw[:, 13]
    b, a = butter(4, 2 * 5.0 * np.median(np.diff(time)))

    def smooth(values: np.ndarray) -> np.ndarray:
        return filtfilt(b, a, values)

    columns = [smooth(np.gradient(speed, time)), smooth(speed), smooth(np.sign(speed))]
    arm = Arm.load(UR10E.arm)
    run = replace(UR10E.held_out[0], stop=1.0).read(measurements, arm)
    metric = CommandError(Recipe(both=5.0), "A")
    paths = ("hub.inertia", "effects.viscous.coefficient", "effects.coulomb.torque")
    for count, printed in ((1, 2.71), (2, 0.613), (3, 0.184)):
        matrix = np.column_stack(columns[:count])
        found = np.linalg.lstsq(matrix, smooth(current), rcond=None)[0]
        expected = float(np.sqrt(np.mean((smooth(current) - matrix @ found) ** 2)))
        values = dict(zip(paths, arm.value("drive.torque_constant") * found, strict=False))
        fitted = arm.with_effect("viscous", coefficient=0.0).with_effect("coulomb", torque=0.0).with_values(values)
        assert metric.of(fitted, [run]) == pytest.approx(expected, rel=1e-4)
        assert expected == pytest.approx(printed, rel=0.02)


def test_the_published_constants_of_the_dfki_pendulum_give_the_figure_beside_them(measurements):
    """J 0.06259, m c 0.1022, viscous 0.04707, Coulomb 0.289 where it saturates, offset −0.07586 by its better sign."""
    rig = next(rig for rig in RIGS if rig.name == "dfki")
    arm = Arm.load(rig.arm)
    arm = arm.with_values({"link.inertia": 0.06259, "link.mass": 0.1022 / arm.value("link.centre")})
    arm = arm.with_effect("viscous", coefficient=0.04707).with_effect("coulomb", torque=0.289)
    runs = [record.read(measurements, arm) for record in rig.held_out]
    found = min(rig.metric.of(arm.with_effect("constant_torque", torque=offset), runs) for offset in (-0.07586, 0.07586))
    assert found == pytest.approx(rig.published[-1].value, rel=2e-3)


def test_dry_friction_holds_an_arm_at_rest_up_to_its_size():
    """A slow rise of the command on an arm that sticks until the command passes the friction."""
    arm = Arm.load("ur10e-joint1").with_effect("coulomb", torque=11.9)
    time = np.arange(0.0, 3.0, 0.01)
    ramp = Recording.from_arrays("ramp", time, "current", 0.5 * time, {}, require_signal=False)
    run = simulate(arm, ramp, noise=False)
    still = run.signals["motor_speed"] == 0.0
    assert still.mean() == pytest.approx(2 / 3, abs=0.01)
    assert CommandError(Recipe(at_rest=1e-9), "A").of(arm, [run.part(0.0, 1.9)]) < 1e-9
    assert CommandError(Recipe(), "A").of(arm, [run.part(0.0, 1.9)]) > 0.5
    weaker = arm.with_values({"effects.coulomb.torque": 0.5 * 11.9})
    assert CommandError(Recipe(at_rest=1e-9), "A").of(weaker, [run.part(1.5, 1.9)]) == pytest.approx(0.35, abs=0.02)


def test_a_delay_and_a_dead_zone_of_the_drive_count():
    arm = Arm.load("ur10e-joint1").with_effect("viscous", coefficient=20.0)
    for effect, values in (("input_delay", {"delay": 0.05}), ("dead_zone", {"width": 1.0})):
        true = arm.with_effect(effect, **values)
        run = simulate(true, "sweep", duration=6.0, rate=500.0, noise=False)
        metric = CommandError(Recipe(both=5.0))
        assert metric.of(true, [run]) < 0.2 * metric.of(arm, [run])


def test_inverse_dynamics_are_those_of_a_rigid_arm_under_current():
    for name in ("thesis", "cu-rigid"):
        arm = Arm.load(name)
        with pytest.raises(InputError, match="inverse dynamics are those of a rigid arm"):
            CommandError(Recipe()).of(arm, [simulate(arm, "pulse", duration=1.0, rate=100.0)])


def test_fit_and_angle_error_are_those_of_the_replays():
    arm = Arm.load("cu-rigid")
    machine = arm.with_effect("viscous", coefficient=0.02)
    runs = [simulate(machine, name, duration=3.0, rate=200.0, noise=False) for name in ("pulse", "sweep")]
    errors, fits = [], []
    for run in runs:
        plant = arm.plant(1.0 / 200.0)
        plant.place()
        measured = run.signals["arm_angle"]
        errors.append(measured - plant.replay(run.command)[:, 0])
        fits.append(100 * (1 - np.linalg.norm(errors[-1]) / np.linalg.norm(measured - measured.mean())))
    assert AngleError(mean_absolute=True).of(arm, runs) == pytest.approx(np.mean([np.abs(e).mean() for e in errors]), rel=0.02)
    assert AngleError().of(arm, runs) == pytest.approx(np.mean([np.sqrt((e**2).mean()) for e in errors]), rel=0.02)
    assert SignalFit().of(arm, runs) == pytest.approx(min(fits), rel=0.02)
