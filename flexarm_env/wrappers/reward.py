"""Reward on a logarithmic scale, from the simulator's true state, which is hidden from the policy."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from flexarm_env.env.batch import Batch
from flexarm_env.env.setup import Setup
from flexarm_env.wrappers.options import RewardOptions

Floats = NDArray[np.float64]

#: Frequency [Hz], about that of the stuck arm: the strain a quarter of its period ago is combined with the present one.
BEAM_FREQUENCY = 2.0
#: Sizes at which the logarithmic costs are 1 [deg, V].
WHOLE_ERROR, WHOLE_STRAIN = 100.0, 3.0


class ShapedReward:
    """Costs of the tip's error, of vibration and of the command for many arms, see RewardOptions.

    Args:
        options: scales and weights.
        setup: of the environment.
        batch: of its arms, which are judged.
    """

    def __init__(self, options: RewardOptions, setup: Setup, batch: Batch) -> None:
        self.options, self.batch = options, batch
        beam = setup.arm.constants.get("beam", {})
        self.length = beam.get("length", 1.0)
        signals = list(setup.arm.signals)
        self.gage = signals.index("strain_base") if "strain_base" in signals else None
        self.quarter = max(round(setup.rate / (4.0 * BEAM_FREQUENCY)), 1)

    def start(self, share: float = 1.0) -> None:
        """Begin an episode of every arm, at a share of the training from 0 to 1; its end by default."""
        # at full weight from the start, a policy learns to avoid regions of costly vibration
        self.vibration = self.options.vibration * (1.0 + share * (self.options.rise - 1.0))
        self.strains = np.tile(self._strain(), (self.quarter, 1))
        self.passed = 0
        self.share = np.zeros(self.batch.count)

    def sample(self) -> Floats:
        """Compute the reward (arms,) of the last sample."""
        options, info = self.options, self.batch.info()
        strain, place = self._strain(), self.passed % self.quarter
        before = self.strains[place].copy()
        self.strains[place], self.passed = strain, self.passed + 1
        error = np.abs(info["hub_angle"] + info["tip_deflection"] / self.length - info["target"])
        far = _share(np.rad2deg(error), options.tip_scale, WHOLE_ERROR)
        shaking = _share(np.hypot(strain, before), options.strain_scale, WHOLE_STRAIN)
        near = np.exp(-np.rad2deg(error) / options.near) if options.near > 0.0 else 1.0
        found: Floats = -far - options.distance * error - self.vibration * near * shaking
        return found

    def command(self, share: Floats) -> Floats:
        """Compute the reward (arms,) of commands over the limit (arms,), once for each action."""
        change, self.share = share - self.share, share
        return -self.options.effort * share**2 - self.options.change * change**2

    def _strain(self) -> Floats:
        """Look up the base strain without noise (arms,) [V]; zeros for an arm without that gage."""
        noiseless = self.batch.noiseless_readings
        return np.zeros(len(noiseless)) if self.gage is None else noiseless[:, self.gage].copy()


def _share(size: Floats, scale: float, whole: float) -> Floats:
    found: Floats = np.log1p(size / scale) / np.log1p(whole / scale)
    return found
