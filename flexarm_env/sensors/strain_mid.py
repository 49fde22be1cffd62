"""A strain gage at the middle of the beam."""

from __future__ import annotations

from flexarm_env.sensors.base import StrainGage


class StrainMid(StrainGage):
    """Strain gage at the middle of the beam, or wherever its `position` is."""

    name = "strain_mid"
    label = "strain, middle"
    measures = "the gage at mid-beam"
    order = 30.0
