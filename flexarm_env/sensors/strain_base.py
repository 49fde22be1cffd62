"""A strain gage at the root of the beam."""

from __future__ import annotations

from flexarm_env.sensors.base import StrainGage


class StrainBase(StrainGage):
    """Strain gage at the root of the beam, or wherever its `position` is."""

    name = "strain_base"
    label = "strain, base"
    measures = "the gage at the root"
    order = 40.0
