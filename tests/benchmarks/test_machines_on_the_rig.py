"""The machines of the benchmark are simulated twice, by the rig and by the package, which share no code."""

from __future__ import annotations

import math

import numpy as np
import pytest

from benchmarks.machines.cases import case
from benchmarks.machines.catalogue import CATALOGUE
from benchmarks.machines.effects import Sized, draw_details
from benchmarks.machines.experiments import runs
from benchmarks.machines.families import FAMILIES
from benchmarks.machines.lacks import possible
from benchmarks.machines.machine import record, shown
from benchmarks.machines.spread import drawn
from flexarm_env import simulate
from flexarm_env.identify.replay.dataset import prepare
from flexarm_env.identify.replay.error_measure import score

#: Parameters of the plant that are details of the rig on another scale.
PHASES = {
    "position_friction": lambda one: {"phase": one.details["posphi"]},
    "cogging": lambda one: {"phase": one.details["phase"]},
    "tach_ripple": lambda one: {"phase": one.details["trip_phi"]},
    "base_tilt": lambda one: {"uphill": one.details["downhill"] - math.copysign(math.pi, one.details["downhill"])},
    "pot_nonlinearity": lambda one: {"phase": 0.0 if one.size > 0.0 else math.pi},
}
#: Gears with play begin in its middle in the plant.
DETAILS = {"backlash": {"gap_at": 0.5}}
#: Sizes over the largest plausible one.
SHARES = {"saturation": 0.8}
#: Largest difference between the two over the noise, and over what the effect changes.
NOISE, SHARE = 0.5, 0.002
#: The same share where the plant resolves a breakaway to a quarter of a sample only: while the drive's output ramps.
RAMPING = {"rate_limit": 0.004}
#: Where the two differ for a reason, in some families: what rounding differs by grows from impact to impact, and where a link
#: turns over; a link that starts off balance falls before its late readings begin; the rig's root is damped as its beam is.
APART = {"backlash", "base_tilt", "time_offset", "root_compliance"}


def difference(arm, command, readings):
    """Compute the largest rms difference of a signal between readings of the rig and those of the package, over the noise."""
    replayed = simulate(arm, command, noise=False)
    pairs = [(replayed.signals[signal] - readings[:, i], arm.reading_noise(signal)) for i, signal in enumerate(arm.signals)]
    return max(float(np.sqrt(np.mean(change**2))) / noise for change, noise in pairs)


@pytest.mark.parametrize("family", FAMILIES)
def test_with_nothing_missing_the_rig_agrees_with_the_plant(family):
    draw = np.random.default_rng([1, list(FAMILIES).index(family)])
    for _ in range(2):
        machine = drawn(draw, FAMILIES[family](draw))
        run = runs(draw, machine)[0]
        recording = record(machine, run)
        readings, _ = shown(machine, recording.command, run.rate)
        assert np.ptp(readings[:, 0]) > 50.0 * machine.arm.reading_noise("arm_angle")
        assert difference(machine.arm, recording, readings) < NOISE


def with_truth(machine, one, arm=None):
    """Give an arm, by default that of the machine, an effect with its true parameters."""
    arm = arm or machine.arm
    absent = {key: 0.0 for key, p in arm.known[one.name].parameters.items() if p.null == 0.0}
    return arm.with_effect(one.name, **absent | one.truth(machine) | PHASES.get(one.name, lambda one: {})(one))


def sized(effect, machine, draw, share=0.2):
    """Draw an effect on a machine, with a share of its largest plausible size."""
    hidden = CATALOGUE[effect]
    size = SHARES.get(effect, share) * hidden.largest(machine) * (-1.0 if hidden.signed else 1.0)
    details = draw_details(draw, hidden, machine) | DETAILS.get(effect, {})
    return Sized(effect.partition(".")[0], hidden, size, details)


def on_both(machine, run, ones):
    """Record a machine with effects; return the differences of the package from it with their true parameters, and without."""
    settings = tuple(one.settings(machine) for one in ones)
    recording = record(machine, run, settings)
    readings, _ = shown(machine, recording.command, run.rate, settings)
    arm = machine.arm
    for one in ones:
        arm = with_truth(machine, one, arm)
    return difference(arm, recording, readings), difference(machine.arm, recording, readings)


def shown_with(effect, draw):
    """Draw machines until an effect that the model of one lacks shows in its recording."""
    while True:
        machine = drawn(draw, list(FAMILIES.values())[draw.integers(len(FAMILIES))](draw))
        if effect not in possible(machine, "all"):
            continue
        one = sized(effect, machine, draw)
        run = runs(draw, machine)[0]
        recording = record(machine, run, (one.settings(machine),))
        readings, _ = shown(machine, recording.command, run.rate, (one.settings(machine),))
        without = difference(machine.arm, recording, readings)
        if without > 2.0:
            return machine, one, recording, readings, without


@pytest.mark.slow(minutes=1)
@pytest.mark.parametrize("family", FAMILIES)
def test_the_true_parameters_of_every_effect_of_a_family_are_those_of_the_plant(family):
    draw, met = np.random.default_rng([3, list(FAMILIES).index(family)]), 0
    for effect in (name for name in CATALOGUE if name not in APART):
        for machine in (drawn(draw, FAMILIES[family](draw)) for _ in range(10)):
            if effect in possible(machine, "all"):
                found, without = on_both(machine, runs(draw, machine)[0], [sized(effect, machine, draw, draw.uniform(0.1, 0.5))])
                assert found < NOISE + RAMPING.get(effect, SHARE) * without, (effect, machine.table)
                met += 1
                break
    assert met > 15


@pytest.mark.parametrize("late", ["input_delay", "time_offset"])
def test_a_drive_that_is_late_within_a_sample_goes_on_ramping_into_the_next(late):
    draw = np.random.default_rng([4])
    for family in ("screw", "rigid_voltage", "flexible_tip"):
        machine = drawn(draw, FAMILIES[family](draw))
        ones = [sized("rate_limit", machine, draw, 0.6), sized(late, machine, draw)]
        found, without = on_both(machine, runs(draw, machine)[0], ones)
        assert found < NOISE + RAMPING["rate_limit"] * without


@pytest.mark.parametrize("effect", CATALOGUE)
def test_the_true_parameters_of_an_effect_are_those_of_the_plant(effect):
    draw = np.random.default_rng([2, list(CATALOGUE).index(effect)])
    machine, one, recording, readings, without = shown_with(effect, draw)
    share = RAMPING.get(effect, SHARE)
    assert difference(with_truth(machine, one), recording, readings) < NOISE + share * without


@pytest.mark.slow
@pytest.mark.parametrize("index", [1, 7, 10, 13, 25])
def test_the_truth_of_a_case_leaves_the_noise(index):
    made = case(2, index)
    complete = made.machine.arm
    for one in made.hidden:
        complete = with_truth(made.machine, one, complete)
    found, without = (score(*prepare(arm, made.recordings)) for arm in (complete, made.machine.arm))
    assert found.windows < 1.1
    assert found.free_run < 1.1
    assert without.windows > 2.0
