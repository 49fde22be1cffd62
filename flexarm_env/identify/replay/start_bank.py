"""Initial states of recordings, kept while the numbers of an arm vary."""

from __future__ import annotations

from dataclasses import dataclass, field

from flexarm_env.identify.replay.dataset import Dataset
from flexarm_env.identify.replay.run import Run
from flexarm_env.identify.replay.start_fit import StartFit
from flexarm_env.plant.plant import Plant


@dataclass(frozen=True)
class StartBank:
    """Initial states, fitted once for each recording and carried along while an arm's numbers are fitted.

    Attributes:
        fitted: by the place of the recording and the number of directions.
    """

    fitted: dict[tuple[int, int], StartFit] = field(default_factory=dict)

    def start(self, plant: Plant, run: Run, place: int, dataset: Dataset) -> StartFit:
        """Carry the initial state of a recording along to an arm; fit it to this arm where there is none yet."""
        stretch = dataset.stretch(run)
        key = (place, stretch.directions(plant))
        if key not in self.fitted:
            self.fitted[key] = stretch.fit(plant)
            return self.fitted[key]
        return stretch.follow(plant, self.fitted[key])
