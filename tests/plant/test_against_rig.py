"""Effects that the rig has, too: its recordings are met to the noise once the model has them."""

from __future__ import annotations

import math

import numpy as np
import pytest

from flexarm_env.arm import Arm
from flexarm_env.identify.data import prepare
from flexarm_env.identify.observer import innovation_sigma
from flexarm_env.identify.problem import Problem, score
from flexarm_env.identify.scales import torque_scale
from flexarm_env.identify.screen import SCREENING_LEVELS
from flexarm_env.recordings.recording import Recording
from tests.rig import SIGNALS, simulate

#: Half the weight of the thesis's beam of 1 m [Nm], on a base tilted by 0.02 rad.
TILTED = 0.02 * 9.81 * 0.42381 / 2.0
HIDDEN = {
    "load_friction": ({"loadf": 0.15}, {"coefficient": 0.15}),
    "presliding": ({"dahl": 60.0}, {"compliance": 1.0 / 60.0}),
    "friction_warmup": ({"warm": 0.35, "warm_tau": 4.0}, {"share": 0.35, "time_constant": 4.0}),
    "base_tilt": ({"tilt": 0.02, "tilt_dir": -0.7}, {"torque": TILTED, "uphill": math.pi - 0.7}),
    "rate_limit": ({"rate": 100.0}, {"rate": 100.0}),
    "gear_compliance": ({"gearc": 300.0}, {"stiffness": 300.0, "damping_time": 2.0 / 300.0}),
}


@pytest.mark.parametrize("name", HIDDEN)
@pytest.mark.parametrize("experiment", ["pulse", "square"])
def test_the_rig_s_recordings_are_met_to_the_noise(name, experiment):
    settings, values = HIDDEN[name]
    made = simulate(settings, experiment, 1)
    recording = Recording.from_arrays(experiment, made["time"], "current", made["current"], {s: made[s] for s in SIGNALS})
    arm, data = prepare(Arm.load("thesis-fem"), [recording])
    right = arm.with_effect(name, **values)
    assert score(arm, data).free_run > 3.0
    assert score(right, data).free_run < 1.02
    for level in SCREENING_LEVELS:  # feedback of the readings does no harm to a model that is right
        torque_noise = level * torque_scale(right, data.runs)
        most = innovation_sigma(right.plant(data.interval), data.noise, torque_noise, data.interval)
        problem = Problem(right, data, [], torque_noise, most[None, :])
        assert np.sqrt(np.mean(problem.residual_of(right) ** 2)) < 1.02
