"""Pictures of an environment: the arm in its present shape and the strain of the last seconds."""

from __future__ import annotations

from collections import deque
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from flexarm_env.env import layout as at
from flexarm_env.env.batch import Batch
from flexarm_env.env.setup import Setup
from flexarm_env.render import Renderer, Scene, beam_shape
from flexarm_env.sensors import known_sensors

STATIONS = 41
TRACE_TIME = 3.0  # [s]


class View:
    """Draws the arms of a batch.

    Args:
        setup: of the environment.
        mode: "human" or "rgb_array".
        fps: frames per second of a window [Hz].
        title: of the pictures; task and arm by default.
    """

    def __init__(self, setup: Setup, mode: Literal["human", "rgb_array"], fps: float, title: str | None = None) -> None:
        structure = setup.arm.structure()
        self.length = structure.length or 1.0
        self.stations = np.linspace(0.0, self.length, STATIONS)
        self.shape = beam_shape(structure, self.stations)
        gages = {name: s["position"] for name, s in setup.arm.sensors.items() if known_sensors()[name].strain}
        self.renderer = Renderer(mode, self.length, fps, tuple(gages.values()))
        self.signals = list(setup.arm.sensors)
        self.bent = next((s for s in ("strain_base", "tip_deflection", "strain_mid") if s in self.signals), None)
        self.setup, self.title = setup, title or f"{setup.task.name} · {setup.arm.name}"
        #: Times and strains of the last seconds of each arm that has been drawn.
        self.traces: dict[int, deque[tuple[float, float]]] = {}

    def draw(self, batch: Batch, arm: int = 0) -> NDArray[np.uint8] | None:
        """Draw an arm in its present state."""
        outcome = batch.outcome[:, arm].tolist()
        time = outcome[at.SAMPLE_COUNT] / self.setup.rate
        trace = self.traces.setdefault(arm, deque(maxlen=round(TRACE_TIME * self.setup.rate)))
        while trace and trace[-1][0] >= time:  # of an episode before, or of a state to which the arm has returned
            trace.pop()
        if self.bent is not None:
            trace.append((time, float(batch.sensor_output[arm, self.signals.index(self.bent)])))
        times, values = np.array(trace).reshape(-1, 2).T
        return self.renderer.draw(
            Scene(
                time=time,
                hub_angle=outcome[at.HUB_ANGLE],
                stuck=outcome[at.STUCK] > 0.0,
                stations=self.stations,
                deflection=self.shape @ batch.physical(arm),
                target=outcome[at.TARGET],
                command=outcome[at.COMMAND] / batch.limit,
                trace=(times, values),
                title=self.title,
            )
        )

    def close(self) -> None:
        """Close the window."""
        self.renderer.close()
