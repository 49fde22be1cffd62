"""The thesis's misprints, each with its effect in numbers: as printed, and corrected."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from typing import Any

import numpy as np

from flexarm_env.thesis import chapter2, chapter3, printed, suppression
from flexarm_env.thesis.constants import INERTIA_CHANGE, TABLE
from flexarm_env.thesis.fixed_step import clamped
from flexarm_env.thesis.runs import INTERVAL
from flexarm_env.thesis.suppression import swing


@dataclass(frozen=True)
class Erratum:
    """A misprint and its effect.

    Attributes:
        number: of docs/thesis.md.
        where: equation, section or figure.
        says: the text as printed.
        should: the corrected text.
        effect: quantity of the two numbers, with unit.
        printed: its value as printed.
        mended: its value when corrected.
        figures: that show both.
    """

    number: str
    where: str
    says: str
    should: str
    effect: str
    printed: float
    mended: float
    figures: tuple[str, ...] = ()

    def as_json(self) -> dict[str, Any]:
        """Convert to plain data."""
        return asdict(self)


def errata() -> list[Erratum]:
    """Evaluate all misprints, in order."""
    found = [*_equations(), *_matrices(), *_beam_torque(), *_rigid(), *_captions(), *_constants()]
    return sorted(found, key=lambda row: int(row.number))


def _equations() -> list[Erratum]:
    shapes, signs = printed.beam_from_shapes(), printed.growth_rate()
    return [
        Erratum(
            "1", "eqs. 3.8, 3.22", "k = ∫ EI φ_i φ_j dx", "∫ EI φ_i″ φ_j″ dx", "first stuck frequency [Hz]", shapes[0], shapes[1]
        ),
        Erratum("2", "eqs. 3.12, 3.30", "M⁻¹K, M⁻¹B", "−M⁻¹K, −M⁻¹B", "fastest growth [1/s]", *signs),
    ]  # fmt: skip


def _matrices() -> list[Erratum]:
    says, should = "first column of M_B and K_B as it is", "divided by N, as θ_1 = θ_m/N asks"
    plain, lighter = printed.first_pinned(), printed.first_pinned(-INERTIA_CHANGE)
    share = 100.0 * INERTIA_CHANGE / TABLE["J_m"]
    return [
        Erratum("3", "M_T after eq. 3.9", says, should, "first pinned frequency [Hz]", *plain, ("3.5",)),
        Erratum("3", "Fig. 3.6", says, should, "the same, J_m less 0.0003 kg m² [Hz]", *lighter, ("3.6",)),
        Erratum("3", "section 3.4", "0.0003 of J_m is 12 %", "of 0.00193 kg m²", "change of J_m [%]", 12.0, share),
    ]


def _beam_torque() -> list[Erratum]:
    made, moment, torque = chapter3.after_pulse("combined"), printed.moment_under_tip_force(), printed.torque_under_tip_force()
    gage = [float(np.max(np.abs(values))) for values in (printed.gage(made), made.strain)]
    wrong, right = suppression.printed_torque(), suppression.without_friction(-1.0)
    left = [swing(found.strain, 3.0, 4.0) for found in (wrong, right)]
    says, should = "EI (0.6 v + 1.3 s)", "EI (−0.6 v + 1.3 s)"
    twice, once = "EI twice in the first term", "(EI/N)(6 (v − Lθ)/L² − 2 (s − θ)/L)"
    double, single = (float(clamped(hub()).frequencies()[0]) for hub in (chapter3.double_inertia, chapter3.hub_inertia))
    return [
        Erratum("4", "section 3.3", says, should, "moment at 0.55 m under 1 N at the tip [Nm]", *moment),
        Erratum("4", "Fig. 3.8", says, should, "largest strain after the pulse [V]", gage[0], gage[1], ("3.8",)),
        Erratum("5", "eq. 4.4", twice, once, "M_o under 1 N at the tip [Nm]", *torque),
        Erratum("5", "Fig. 4.7", twice, once, "strain from 3 to 4 s, peak to peak [V]", left[0], left[1], ("4.7",)),
        Erratum(
            "10", "eq. 3.26", "J of eq. 2.1, with the arm in it", "J_m + J_hub/N²: M_o is the arm's reaction",
            "frequency of the clamped model [Hz]", double, single, ("3.7", "4.2", "4.3"),
        ),
    ]  # fmt: skip


def _rigid() -> list[Erratum]:
    first = slice(0, round(2.5 / INTERVAL))
    undamped, damped = (float(r.angle[first].max()) for r in (chapter2.misprinted_friction(), chapter2.rigid(gap=False)))
    apart = [int(np.sum(np.diff(chapter2.collision(True, False, flag)[:, 4] == 0.0) > 0)) for flag in (True, False)]
    partings = [-(-count // 2) for count in apart]
    heavy, light = (chapter2.rigid(gap=False, printed=flag).angle for flag in (True, False))
    end = round(4.9 / INTERVAL)
    return [
        Erratum(
            "6", "eq. 2.3", "b_s ω̇_a", "b_s ω_a", "largest angle in the first half period of Fig. 2.6 [°]", undamped, damped,
            ("2.6",),
        ),
        Erratum(
            "6", "eq. 2.22", "gears part where a speed changes sign", "where the force between them would pull",
            "partings of the gears in 10 s", float(partings[0]), float(partings[1]), ("2.7", "2.8"),
        ),
        Erratum("7", "Table 2.1", "J_a = 0.158 kg m²", "m L³/3 + 0.00129", "J_a [kg m²]", *printed.rigid_inertia()),
        Erratum(
            "7", "Table 2.1", "J_a = 0.158 kg m²", "m L³/3 + 0.00129 = 0.1426", "hub angle at 4.9 s in Fig. 2.6 [°]",
            float(heavy[end]), float(light[end]), ("2.6",),
        ),
    ]  # fmt: skip


def _captions() -> list[Erratum]:
    found = []
    for figure, compensation in (("4.12", False), ("4.13", True)):
        wrong, right = (swing(suppression.with_friction(0.0, gain, compensation).strain, 4.0, 5.0) for gain in (-1.0, 1.0))
        effect = "strain in the fifth second, peak to peak [V]"
        found.append(
            Erratum("8", f"caption of Fig. {figure}", "K_mo = −1", "+1, as in the text", effect, wrong, right, (figure,))
        )
    return found


def _constants() -> list[Erratum]:
    says, should = "R_a = 1.23 Ω", "1.35 Ω, which column E follows"
    return [Erratum("9", "App. A, experiment 1", says, should, "mean kφ [Vs/rad]", *printed.mean_motor_constant(), ("A.1",))]
