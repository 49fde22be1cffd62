"""Rows T11 to T16: K_mo M_o(t − t_d) after a pulse, by model and region of speed."""

from __future__ import annotations

import numpy as np

from flexarm_env.thesis import chapter3, suppression
from flexarm_env.thesis.claims.claim import Claim, Part
from flexarm_env.thesis.constants import CLAMPED_DELAY
from flexarm_env.thesis.frequency import vibration
from flexarm_env.thesis.runs import clock
from flexarm_env.thesis.suppression import swing, with_friction

#: Strains [V from peak to peak] within this share of each other count as equal, neither better nor worse.
SAME = 0.05


def clamped_model() -> Claim:
    """T11."""
    double, single = chapter3.double_inertia(), chapter3.hub_inertia()
    free, at_once, late = (chapter3.clamped_control(double, *law) for law in ((0.0,), (-1.0,), (-1.0, CLAMPED_DELAY)))
    time = clock(len(free))
    speed = [vibration(time, out[:, 1], 1.0, 5.0).amplitude for out in (free, at_once)]
    strain = [vibration(time, out[:, 2], 1.0, 5.0) for out in (free, at_once, late)]
    swings = [swing(out[:, 2], 4.0, 5.0) for out in (free, at_once, late)]
    once = swing(chapter3.clamped_control(single, -1.0, CLAMPED_DELAY)[:, 2], 4.0, 5.0)
    return Claim(
        "T11",
        "section 4.1, Figs. 4.2 and 4.3",
        "Clamped model without friction: K_mo = −1, t_d = 0 takes the vibration out of the speed but not out of the beam; "
        "t_d = 0.074 s damps the beam.",
        [
            Part(
                f"vibration of the speed {speed[0]:.2f} → {speed[1]:.1g} rad/s; the beam swings on at "
                f"{strain[1].frequency:.2f} Hz, {swings[1]:.2f} V from peak to peak over the fifth second",
                speed[1] < 1e-3 * speed[0] and abs(strain[1].decay) < 0.05,
                {
                    "speed, free [rad/s]": speed[0],
                    "speed, t_d = 0 [rad/s]": speed[1],
                    "strain, t_d = 0 [Hz]": strain[1].frequency,
                    "strain, t_d = 0 [V]": swings[1],
                },
            ),
            Part(
                f"with t_d = {CLAMPED_DELAY} s {swings[2]:.3f} V are left over the fifth second of {swings[0]:.2f} V "
                "without control",
                swings[2] < 0.2 * swings[0],
                {"strain, t_d = 0.074 s [V]": swings[2], "strain, free [V]": swings[0]},
            ),
        ],
        "−M_o cancels the beam's torque on the hub and leaves a beam on a hub that does not feel it, in any model of this "
        "form. The delay is a quarter period of the model that counts the arm twice (T8); with the arm counted once the "
        f"same delay makes the beam {'diverge' if once > swings[0] else 'calm'}.",
        ("4.2", "4.3"),
    )


def delayed_torque() -> Claim:
    """T12."""
    wild, held = suppression.delayed(limited=False), suppression.delayed(limited=True)
    late = held.between(4.0, 5.0)
    reach = [float(held.command[late].min()), float(held.command[late].max())]
    size = swing(held.strain, 4.0, 5.0)
    grown = float(np.max(np.abs(wild.strain)))
    return Claim(
        "T12",
        "section 4.1, Figs. 4.4 and 4.5",
        "Pinned model with friction: K_mo = −1, t_d = 0.026 s is unstable; with the current limited to 5 A it goes on "
        "oscillating in saturation.",
        [
            Part(
                f"it diverges: at {wild.time[-1]:.2f} s the strain has passed {grown:.0f} V",
                grown > 1e3,
                {"strain [V]": grown, "at [s]": float(wild.time[-1])},
            ),
            Part(
                f"with 5 A the current goes from {reach[0]:.0f} to {reach[1]:.0f} A in the fifth second, and the strain "
                f"swings by {size:.1f} V",
                reach == [-5.0, 5.0] and size > 1.0,
                {"current, least [A]": reach[0], "current, most [A]": reach[1], "strain [V]": size},
            ),
        ],
        "the delay turns the torque on the hub by a quarter of the pinned period, from one that stiffens into one that drives.",
        ("4.4", "4.5", "4.6"),
    )


def torque_at_once() -> Claim:
    """T13."""
    runs = suppression.without_friction(0.0), suppression.without_friction(-1.0), suppression.sampled_without_friction()
    free, held, sampled = (vibration(r.time, r.strain, 1.2, 2.5, (1.0, 16.0)) for r in runs)
    ratios = [v.decay / (2.0 * np.pi * v.frequency) for v in (free, held)]
    most = [float(np.max(np.abs(r.strain))) for r in runs]
    return Claim(
        "T13",
        "section 4.2, Fig. 4.7",
        "Pinned model without dry friction: K_mo = −1, t_d = 0 reduces the beam's vibration.",
        [
            Part(
                f"more is lost in each cycle: the damping ratio rises from {ratios[0]:.3f} to {ratios[1]:.3f}",
                ratios[1] > ratios[0],
                {"damping ratio, free": ratios[0], "damping ratio": ratios[1]},
            ),
            Part(
                f"but cycles take longer, {free.frequency:.2f} → {held.frequency:.2f} Hz, so that it decays by "
                f"{held.decay:.2f}/s in place of {free.decay:.2f}/s, from {most[1]:.1f} V at most in place of "
                f"{most[0]:.1f} V",
                held.decay > free.decay,
                {
                    "free [Hz]": free.frequency,
                    "controlled [Hz]": held.frequency,
                    "decay, free [1/s]": free.decay,
                    "decay [1/s]": held.decay,
                    "decay, sampled at 5 ms [1/s]": sampled.decay,
                    "largest strain, free [V]": most[0],
                    "largest strain [V]": most[1],
                },
            ),
        ],
        "−M_o takes the beam's torque from the hub, which then gives way at a lower frequency, and its viscous friction "
        f"takes the energy. With the command held for 5 ms, as on a rig, it does damp, by {sampled.decay:.1f}/s: a delay "
        "of half a sample helps here, and one of 26 ms does not (T12).",
        ("4.7",),
    )


def with_dry_friction() -> Claim:
    """T14."""
    free = swing(chapter3.after_pulse("combined").strain, 4.0, 5.0)
    plain, helped = with_friction(-1.0, -1.0), with_friction(-1.0, -1.0, True)
    found = [swing(made.strain, 4.0, 5.0) for made in (plain, helped)]
    return Claim(
        "T14",
        "section 4.3, Figs. 4.8 and 4.9",
        "With friction the same controller does not damp at low speed, not even with friction compensation there.",
        [
            Part(
                f"{name}: {value:.2f} V from peak to peak over the fifth second, {free:.2f} V without control",
                value > 0.8 * free,
                {f"{name} [V]": value},
            )
            for name, value in zip(("without compensation", "with compensation"), found, strict=True)
        ],
        f"the hub sticks at {plain.rest():.2f} s, or {helped.rest():.2f} s with compensation, while the beam still swings, "
        "larger than before since −M_o drove it; a hub that is held takes no energy out.",
        ("4.8", "4.9"),
    )


def positive_gain() -> Claim:
    """T15."""
    free, plain, helped = chapter3.after_pulse("combined"), with_friction(1.0, 1.0), with_friction(1.0, 1.0, True)
    decays = [vibration(r.time, r.strain, *span, (4.0, 16.0)).decay for r, span in ((free, (1.02, 2.0)), (plain, (0.52, 1.5)))]
    most = [float(np.max(np.abs(r.strain))) for r in (free, plain)]
    left = [swing(free.strain, 4.0, 5.0), swing(plain.strain, 4.0, 5.0), swing(helped.strain, 4.0, 5.0)]
    return Claim(
        "T15",
        "section 4.3, Figs. 4.10 and 4.11",
        "K_mo = +1 raises the vibration at high speed and damps it at low speed, better so with friction compensation.",
        [
            Part(
                f"at high speed the vibration decays by {decays[1]:.2f}/s in place of {decays[0]:.2f}/s",
                decays[1] < decays[0],
                {"decay, free [1/s]": decays[0], "decay [1/s]": decays[1]},
            ),
            Part(
                f"but it is no larger: {most[1]:.2f} V at most in place of {most[0]:.2f} V",
                most[1] > most[0],
                {"largest strain, free [V]": most[0], "largest strain [V]": most[1]},
            ),
            Part(
                f"{left[1]:.3f} V from peak to peak are left in the fifth second in place of {left[0]:.3f} V, with "
                f"compensation {left[2]:.3f} V",
                left[2] < left[1] < left[0],
                {"left, free [V]": left[0], "left [V]": left[1], "left, compensated [V]": left[2]},
            ),
        ],
        "+M_o stiffens the hub: it takes 1 A and more out of the pulse, which strikes the beam less, and lets the viscous "
        f"friction take less out of it. The hub goes to {plain.angle[-1]:.0f}° in place of {free.angle[-1]:.0f}°.",
        ("4.10", "4.11"),
    )


def by_region() -> Claim:
    """T16."""
    free = chapter3.after_pulse("combined")
    before = swing(free.strain, 4.0, 5.0)
    low, helped = with_friction(0.0, 1.0), with_friction(0.0, 1.0, True)
    caption = with_friction(0.0, -1.0)
    both = with_friction(-1.0, 1.0, True, limited=False)
    left = [swing(low.strain, 4.0, 5.0), swing(helped.strain, 4.0, 5.0), swing(caption.strain, 4.0, 5.0)]
    whole, capped = (swing(with_friction(-1.0, 1.0, True, limited=flag).strain, 4.0, 5.0) for flag in (False, True))
    return Claim(
        "T16",
        "sections 4.3 and 4.4, Figs. 4.12 to 4.14",
        "K_mo = +1 at low speed only damps without touching the motion at high speed, better with compensation; so does "
        "the combined controller (−1 from 0.03 rad/s of the motor on, +1 with compensation below).",
        [
            Part(
                f"low speed only: {left[0]:.3f} V from peak to peak in the fifth second in place of {before:.3f} V, at "
                f"{low.angle[-1]:.1f}° in place of {free.angle[-1]:.1f}°; the captions' −1 leaves {left[2]:.3f} V",
                left[0] < 0.8 * before and abs(low.angle[-1] - free.angle[-1]) < 5.0,
                {"without control [V]": before, "low speed [V]": left[0], "low speed, K_mo = −1 [V]": left[2]},
            ),
            Part(
                f"with compensation {left[1]:.3f} V",
                left[1] < (1.0 - SAME) * left[0],
                {"low speed, compensated [V]": left[1]},
            ),
            Part(
                f"combined, current unlimited: {whole:.2f} V in the fifth second, at {both.angle[-1]:.0f}°",
                whole < (1.0 - SAME) * before,
                {"combined [V]": whole, "combined, 5 A [V]": capped},
            ),
        ],
        f"the low-speed term acts for a short time, and the hub comes to rest at {low.rest():.2f} s with what is left. At "
        "high speed −1 drives the beam through the pulse and feeds on dry friction (T14), so the low-speed part of the "
        "combined controller begins with a larger swing, and more is left in the fifth second than without control; with "
        f"5 A {capped:.2f} V.",
        ("4.12", "4.13", "4.14"),
    )
