"""Inputs and outputs of a policy: readings, filters and a classical controller in, commands out."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from flexarm_env.arm import Arm
from flexarm_env.controllers import make_controller
from flexarm_env.controllers.estimator import Estimator, row_dot
from flexarm_env.controllers.loads import KnownLoads
from flexarm_env.controllers.lqg import LQG
from flexarm_env.controllers.payload import PayloadEstimator, shows_payload
from flexarm_env.wrappers.options import InterfaceOptions

Floats = NDArray[np.float64]

#: Below these sizes a feature is nearly linear, above it grows with the logarithm: 0.1° and 100° both have to be resolved.
FINE = {"arm_angle": 0.01, "motor_speed": 0.1, "strain_mid": 0.02, "strain_base": 0.02, "tip_deflection": 0.001}
#: The same of another signal, over its typical reading.
FINE_SHARE = 0.01
FINE_STATE = {"hub": 0.003, "hub_rate": 0.03, "tip": 0.001, "tip_rate": 0.01, "friction": 0.1}
#: Features are divided by this, so that most are within ±2.
SPREAD = 3.0
#: Largest feature: far beyond what any reading or estimate gives, and finite, as checkers of environments ask for.
LARGEST_FEATURE = 20.0
PAYLOAD_SCALE = 0.15


def squeezed(value: Floats, fine: float | Floats) -> Floats:
    """Compute asinh(value / fine) over the common spread."""
    squeezed: Floats = np.arcsinh(value / fine) / SPREAD
    return squeezed


class PolicyInterface:
    """Between a policy and many arms, at every sample: `see` readings, `features` for the policy, `send` its action.

    Args:
        options: features, and effect of the actions.
        arm: modelled by the policy's filters and its base controller.
        interval: control period [s].

    Raises:
        InputError: for an arm that lacks what the filters or the base controller need.
    """

    def __init__(self, options: InterfaceOptions, arm: Arm, interval: float) -> None:
        self.options, self.arm, self.signals = options, arm, list(arm.signals)
        self.limit = arm.constants["drive"]["limit"]
        self.base = make_controller(options.base, arm, interval) if options.base != "none" else None
        self.loads = KnownLoads(arm)
        self.estimator = Estimator(arm, interval) if options.estimate else None
        self.weigher = PayloadEstimator(arm, interval) if options.estimate and shows_payload(arm) else None
        #: Weight of each new reading in an average (averages, 1, 1).
        self.fresh = 1.0 - np.exp(-interval / np.array(options.averages).reshape(-1, 1, 1))
        self.depth = max([*options.lags, *options.command_lags], default=0) + 1
        self.fine = np.array([FINE.get(signal, FINE_SHARE * arm.sensor(signal).typical) for signal in self.signals])
        self.angle = self.signals.index("arm_angle")
        self.start(1)
        self.size = self.features().shape[1]

    def start(self, count: int) -> None:
        """Start an episode of `count` arms."""
        self.count, self.sample = count, -1
        self.readings = np.zeros((self.depth, count, len(self.signals)))
        self.averages = np.zeros((len(self.fresh), count, len(self.signals)))
        self.commands = np.zeros((self.depth, count))
        self.target, self.wanted = np.zeros(count), np.zeros(count)
        self.last = np.zeros((count, self.options.actions))
        self.command = np.zeros(count)
        if self.base:
            self.base.reset(count)
        if self.estimator:
            self.estimator.start(count)
            self.state = self.estimator.state
        if self.weigher:
            self.weigher.start(count)
            self.payload = self.weigher.payload

    def see(self, observation: NDArray[np.floating[Any]]) -> None:
        """Update by physical observations (count, signals + 1) of a sample."""
        seen = np.asarray(observation, dtype=np.float64)
        self.sample += 1
        here = self.sample % self.depth
        if self.sample == 0:
            self.readings[:] = self.averages[:] = seen[:, :-1]
        self.averages += self.fresh * (seen[:, :-1] - self.averages)
        self.readings[here], self.target = seen[:, :-1], seen[:, -1]
        if self.base:
            self.wanted = self.base.act(seen) / self.limit
        if self.estimator:
            self.state = self.estimator.correct(seen[:, :-1])
        if self.weigher:
            self.payload = self.weigher.update(seen[:, :-1])

    def features(self) -> NDArray[np.float32]:
        """Compute the policy's features (count, size)."""
        here, options = self.sample % self.depth, self.options
        found = []
        for shown in [*(self.readings[(here - lag) % self.depth] for lag in options.lags), *self.averages]:
            readings = shown.copy()
            readings[:, self.angle] = self.target - readings[:, self.angle]
            found.append(squeezed(readings, self.fine))
        for lag in options.command_lags:
            found.append(self.commands[(here - 1 - lag) % self.depth][:, None])
        if self.estimator:
            found += self._estimates(self.estimator)
        if self.base:
            found += [self.wanted[:, None], self.last]
        features = np.concatenate(found, axis=1, dtype=np.float32)
        return np.clip(features, -LARGEST_FEATURE, LARGEST_FEATURE)

    def _estimates(self, estimator: Estimator) -> list[Floats]:
        model, moving = estimator.model, self.state[:, :-1]
        bends = [name for name in model.names if name.startswith("deflection") and not name.endswith("_rate")]
        rows = {"hub": "hub", "hub_rate": "hub_rate"}
        if bends:
            rows |= {"tip": bends[-1], "tip_rate": f"{bends[-1]}_rate"}
        found = {name: row_dot(model.row(state), moving) for name, state in rows.items()}
        found["hub"] = self.target - found["hub"]
        found["friction"] = self.state[:, -1]
        columns = [squeezed(values, FINE_STATE[name])[:, None] for name, values in found.items()]
        return [*columns, (self.payload / PAYLOAD_SCALE)[:, None]] if self.weigher else columns

    def send(self, action: NDArray[np.floating[Any]]) -> NDArray[np.float32]:
        """Convert an action (count, 1 or 2) to shares of the limit (count, 1) at this sample."""
        options = self.options
        self.last = np.clip(np.asarray(action, dtype=np.float64), -1.0, 1.0)
        added = options.authority * self.last[:, 0]
        if options.pulse and self.sample % options.repeat == 0:
            added += options.pulse * self.last[:, 1]
        share = np.clip(self.wanted + added, -1.0, 1.0)
        self.commands[self.sample % self.depth] = self.command = share
        acts = self.loads.behind_dead_zone(share * self.limit)
        if self.estimator:
            self.estimator.predict(acts)
        if isinstance(self.base, LQG):
            self.base.amend(acts - self.loads.behind_dead_zone(self.wanted * self.limit))
        return share[:, None].astype(np.float32)
