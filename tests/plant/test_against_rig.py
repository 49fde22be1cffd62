"""Effects that the rig has, too: its recordings are met to the noise once the model has them."""

from __future__ import annotations

import math

import numpy as np
import pytest

from flexarm_env.arm import Arm
from flexarm_env.identify.calibrate.objective import Objective, Weights
from flexarm_env.identify.calibrate.parameters import FitParameters
from flexarm_env.identify.replay.dataset import prepare
from flexarm_env.identify.replay.error_measure import score
from flexarm_env.identify.replay.observer import innovation_sigma
from flexarm_env.identify.replay.scales import torque_scale
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
    "end_stop": ({"stop": 5.0, "stop_at": 0.4}, {"stiffness": 5.0, "upper": 0.4, "lower": -0.4, "damping_time": 0.0}),
    "gear_compliance": ({"gearc": 300.0}, {"stiffness": 300.0, "damping_time": 2.0 / 300.0}),
}
#: Effects that act on one another: warming takes dry friction only.
TOGETHER = {
    "friction_warmup, asymmetric_viscous": (
        {"warm": 0.35, "warm_tau": 4.0, "asymv": 0.05},
        {"friction_warmup": {"share": 0.35, "time_constant": 4.0}, "asymmetric_viscous": {"coefficient": 0.05}},
    )
}
ALL = {name: (settings, {name: values}) for name, (settings, values) in HIDDEN.items()} | TOGETHER


@pytest.mark.parametrize("name", ALL)
@pytest.mark.parametrize("experiment", ["pulse", "square"])
def test_the_rig_s_recordings_are_met_to_the_noise(name, experiment):
    settings, effects = ALL[name]
    made = simulate(settings, experiment, 1)
    recording = Recording.from_arrays(experiment, made["time"], "current", made["current"], {s: made[s] for s in SIGNALS})
    arm, data = prepare(Arm.load("thesis-fem"), [recording])
    right = arm
    for effect, values in effects.items():
        right = right.with_effect(effect, **values)
    assert score(arm, data).free_run > 3.0
    assert score(right, data).free_run < 1.02
    for level in data.settings.process_noise.screening:  # feedback of the readings does no harm to a model that is right
        torque_noise = level * torque_scale(right, data.runs)
        most = innovation_sigma(right.plant(data.interval), data, torque_noise)
        problem = Objective(right, data, FitParameters(), torque_noise, Weights(most[None, :], np.empty(0), most[None, :]))
        assert np.sqrt(np.mean(problem.residual_of(right) ** 2)) < 1.02
