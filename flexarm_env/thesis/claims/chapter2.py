"""Rows T3 and T4: the rigid model."""

from __future__ import annotations

import numpy as np

from flexarm_env.thesis import chapter2
from flexarm_env.thesis.claims.claim import Claim, Part


def position() -> Claim:
    """T3."""
    rigid, flexible = chapter2.rigid(gap=False), chapter2.flexible()
    ends = [abs(rigid.angle[rigid.between(t, t + 0.1)].mean()) for t in (2.3, 4.8, 7.3)]
    apart = np.interp(rigid.time, flexible.time, flexible.angle) - rigid.angle
    rms = float(np.sqrt(np.mean(apart**2)))
    turns, rough = chapter2.swings(rigid.speed), chapter2.swings(chapter2.flexible_quiet().speed)
    return Claim(
        "T3",
        "section 2.3, Fig. 2.6",
        "The rigid model under PD (P = 2.5308, D = 0.6625) on a square wave of ±50°, 0.2 Hz matches the position, and its "
        "speed does not oscillate.",
        [
            Part(
                f"the hub goes to {ends[0]:.1f}°, then to ±{ends[1]:.1f}°; beside the flexible arm that stands in for the "
                f"rig its angle is {rms:.2f}° rms off",
                rms < 3.0,
                {"end of first half period [°]": ends[0], "end of second [°]": ends[1], "from flexible arm [°]": rms},
            ),
            Part(
                "from 50 ms after a step on the rigid arm's speed turns round once, at its peak; the flexible arm's "
                f"{rough} times",
                turns == 1,
                {"turning points, rigid": float(turns), "turning points, flexible": float(rough)},
            ),
        ],
        "the beam hardly moves the hub's slow motion, but its vibration is what the speed shows. The rig's recordings are "
        "not printed as numbers, so a finer model with noise stands in for them.",
        ("2.6", "2.9"),
    )


def backlash() -> Claim:
    """T4."""
    runs = {key: chapter2.rigid(*key).speed for key in ((True, False), (False, False), (True, True))}
    jumps = {key: chapter2.jump(speed) for key, speed in runs.items()}
    law = {key: chapter2.jump(chapter2.collision(*key)[:, 1]) for key in runs}
    on, off, slow = jumps.values()
    return Claim(
        "T4",
        "section 2.3, Figs. 2.7 and 2.8",
        "The small jump of speed at the set-point step is there with backlash, gone without, and smaller when the "
        "current's rate is limited; backlash has little effect.",
        [
            Part(
                f"with backlash the motor jumps by {on:.2f} rad/s ({law[True, False]:.2f} by the collision of eq. 2.19)",
                on > 0.5 and law[True, False] > 0.5,
                {"with backlash [rad/s]": on, "with backlash, eq. 2.19 [rad/s]": law[True, False]},
            ),
            Part(f"without by {off:.2f}", off < 0.01 * on, {"without backlash [rad/s]": off}),
            Part(
                f"with the current at 50 A/s by {slow:.2f} ({law[True, True]:.2f})",
                slow < on and law[True, True] < law[True, False],
                {"rate limited [rad/s]": slow, "rate limited, eq. 2.19 [rad/s]": law[True, True]},
            ),
            _little_effect(),
        ],
        "at rest the teeth lie on the side from which the arm was pushed last; the step drives the motor alone through "
        "the gap, until it hits the arm. The effect `backlash` has teeth that give way and rebound, eq. 2.19 has none of "
        "it; arm and speed before the blow are the same. The thesis gives no rate; 50 A/s is the product's.",
        ("2.7", "2.8"),
    )


def _little_effect() -> Part:
    with_gap, without = chapter2.rigid(gap=True), chapter2.rigid(gap=False)
    most = float(np.max(np.abs(with_gap.angle - without.angle)))
    words = f"it moves the hub's angle by {most:.2f}° at most"
    return Part(words, most < 0.5, {"largest change of angle [°]": most})
