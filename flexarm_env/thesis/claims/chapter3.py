"""Rows T5 to T10: the flexible model after a pulse of current."""

from __future__ import annotations

import numpy as np

from flexarm_env.thesis import chapter3, printed
from flexarm_env.thesis.claims.claim import Claim, Part
from flexarm_env.thesis.constants import CLAMPED_DELAY, INERTIA_CHANGE, RIG_MOVING, TABLE
from flexarm_env.thesis.fixed_step import clamped
from flexarm_env.thesis.frequency import vibration
from flexarm_env.thesis.runs import DURATION, clock


def two_frequencies() -> Claim:
    """T5."""
    made = chapter3.after_pulse("combined")
    strain, speed, stuck = chapter3.moving("combined"), chapter3.moving("combined", "motor_speed"), chapter3.stuck("combined")
    rest, end = made.rest(), made.angle[-1]
    near = vibration(made.time, made.speed, rest - 0.4, rest - 0.01, (4.0, 16.0)).frequency
    still = float(np.max(np.abs(made.speed[made.between(rest, DURATION)])))
    return Claim(
        "T5",
        "sections 3 and 3.4, Figs. 3.1 and 3.8",
        "After 3 A from 0.5 to 1.0 s strain and speed vibrate at about 10 Hz while the hub moves; once it is stuck the "
        "strain vibrates at about 2.4 Hz and the speed not at all.",
        [
            Part(
                f"moving, strain {strain.frequency:.2f} Hz and speed {speed.frequency:.2f} Hz, {near:.2f} Hz still in the "
                f"last 0.4 s before it sticks, {100.0 * (1.0 - strain.frequency / RIG_MOVING):.0f} % below the rig's 10 Hz",
                abs(strain.frequency / RIG_MOVING - 1.0) < 0.05,
                {
                    "strain, moving [Hz]": strain.frequency,
                    "speed, moving [Hz]": speed.frequency,
                    "speed, nearly stuck [Hz]": near,
                },
            ),
            Part(
                f"stuck from {rest:.2f} s on, at {end:.1f}°: strain {stuck.frequency:.3f} Hz",
                abs(stuck.frequency / 2.4 - 1.0) < 0.03,
                {"stuck from [s]": rest, "end [°]": float(end), "strain, stuck [Hz]": stuck.frequency},
            ),
            Part(f"and speed {still:g} rad/s", still == 0.0, {"speed, stuck [rad/s]": still}),
        ],
        "the consistent matrices give 8.96 Hz with the inertias of Table 2.1. 10 Hz comes out only with the printed M_T "
        "(erratum 3) or a lighter hub, so the rig holds an effect, or an inertia, that the model misses.",
        ("3.1", "3.8"),
    )


def falling_frequency() -> Claim:
    """T6."""
    made = chapter3.after_pulse("coulomb")
    before, after = chapter3.moving("coulomb"), vibration(made.time, made.strain, 2.85, DURATION, (0.8, 4.0))
    late = vibration(made.time, made.speed, 1.7, 2.18, (4.0, 16.0))
    first = float(made.time[np.flatnonzero(made.stuck & (made.time > 1.0))[0]])
    slips = made.between(first, made.rest())
    share = 100.0 * float(np.mean(~made.stuck[slips]))
    numbers = {
        "moving [Hz]": before.frequency,
        "last 0.5 s before the first stop [Hz]": late.frequency,
        "after it [Hz]": after.frequency,
        "first stop [s]": first,
        "last motion [s]": made.rest(),
        "slipping between [%]": share,
    }
    return Claim(
        "T6",
        "section 3.4, Fig. 3.5",
        "With Coulomb friction only, and no static friction, the frequency falls towards the clamped one as the speed "
        "nears zero; the hub still turns.",
        [
            Part(
                f"the strain goes from {before.frequency:.2f} to {after.frequency:.2f} Hz (clamped 2.43), and the hub "
                f"still slips now and then until {made.rest():.2f} s",
                abs(after.frequency / 2.43 - 1.0) < 0.05 and made.rest() > first + 0.5,
                numbers,
            ),
            Part(
                f"but it does not fall with the speed: it is {late.frequency:.2f} Hz over the half second before the hub's "
                f"first stop at {first:.2f} s",
                late.frequency < 0.8 * before.frequency,
            ),
        ],
        "while the hub turns one way, Coulomb friction is a constant torque and changes no frequency. After the first "
        "stop it holds the hub as static friction would: between its first stop and its last motion the hub slips for "
        f"{share:.1f} % of the time.",
        ("3.5",),
    )


def motor_inertia() -> Claim:
    """T7."""
    found = {name: chapter3.moving(name).frequency for name in ("lighter", "coulomb", "heavier", "printed", "printed, lighter")}
    as_printed = printed.first_pinned(-INERTIA_CHANGE)[0]
    share = 100.0 * INERTIA_CHANGE / TABLE["J_m"]
    return Claim(
        "T7",
        "section 3.4, Fig. 3.6",
        "J_m less 0.0003 kg m², a change of 12 %, makes the pinned frequency match the rig's 10 Hz.",
        [
            Part(
                f"{found['coulomb']:.2f} Hz becomes {found['lighter']:.2f} Hz (and {found['heavier']:.2f} Hz with 0.0003 more)",
                found["lighter"] > found["coulomb"],
                {f"{name} [Hz]": value for name, value in found.items()},
            ),
            Part(
                f"{100.0 * (1.0 - found['lighter'] / RIG_MOVING):.0f} % below 10 Hz; with the printed M_T it is "
                f"{found['printed']:.2f} and {found['printed, lighter']:.2f} Hz (undamped {as_printed:.3f})",
                abs(found["lighter"] / RIG_MOVING - 1.0) < 0.05,
            ),
            Part(f"0.0003 of {TABLE['J_m']} is {share:.1f} %", abs(share - 12.0) < 1.0, {"change of J_m [%]": share}),
        ],
        "the first column of M_T was not divided by N (erratum 3), which makes the hub lighter by a third; with it the "
        "thesis reaches the rig's frequency, with the consistent matrices the model stays below.",
        ("3.5", "3.6"),
    )


def clamped_alone() -> Claim:
    """T8."""
    double, single = chapter3.double_inertia(), chapter3.hub_inertia()
    found = {}
    for name, hub in (("double", double), ("single", single)):
        out = chapter3.clamped_pulse(hub)
        time = clock(len(out))
        found[name] = (vibration(time, out[:, 2], 1.02, 1.5, (1.0, 16.0)).frequency, float(np.max(np.abs(out[:, 2]))))
    exact = {name: clamped(hub).frequencies()[0] for name, hub in (("double", double), ("single", single))}
    rig, most = chapter3.moving("combined").frequency, float(np.max(np.abs(chapter3.after_pulse("combined").strain)))
    return Claim(
        "T8",
        "section 3.4, Fig. 3.7",
        "The clamped model alone has neither the right frequencies nor the right amplitudes, so a moving hub needs the "
        "pinned model.",
        [
            Part(
                f"as printed it vibrates at {found['double'][0]:.2f} Hz (undamped {exact['double']:.2f}) where the pinned "
                f"model has {rig:.2f}, and reads {found['double'][1]:.2f} V at most in place of {most:.2f} V",
                abs(found["double"][0] / rig - 1.0) > 0.3,
                {
                    "as printed [Hz]": found["double"][0],
                    "as printed, undamped [Hz]": float(exact["double"]),
                    "as printed, largest strain [V]": found["double"][1],
                    "pinned, largest strain [V]": most,
                },
            ),
            Part(
                f"but with the arm's inertia counted once it vibrates at {found['single'][0]:.2f} Hz (undamped "
                f"{exact['single']:.2f}) and reads {found['single'][1]:.2f} V",
                abs(found["single"][0] / rig - 1.0) > 0.3,
                {
                    "counted once [Hz]": found["single"][0],
                    "counted once, undamped [Hz]": float(exact["single"]),
                    "counted once, largest strain [V]": found["single"][1],
                },
            ),
        ],
        "eq. 3.26 puts the J of eq. 2.1, with the arm in it, beside M_o, which is the arm's reaction already: the arm "
        f"counts twice (erratum 10). A quarter of that model's period is {0.25 / exact['double']:.3f} s, the thesis's t_d "
        f"of {CLAMPED_DELAY} s. A beam seen from a hub that turns is the pinned beam in other coordinates, so the boundary "
        "condition is not what went wrong; what is left of the difference is that one element's EI y″(0) is not its "
        "reaction.",
        ("3.7",),
    )


def beam_damping() -> Claim:
    """T9."""
    plain, damped = chapter3.after_pulse("combined"), chapter3.after_pulse("damped")
    second = [vibration(r.time, r.strain, 1.02, 1.4, (20.0, 40.0)).decay for r in (plain, damped)]
    first = [chapter3.moving(name) for name in ("combined", "damped")]
    size = [float(np.ptp(r.strain[r.between(1.5, 2.0)])) for r in (plain, damped)]
    return Claim(
        "T9",
        "section 3.4, Fig. 3.9",
        "Damping of 0.003 Nms in the pinned beam makes the oscillations smooth, as on the rig, and their amplitude greater.",
        [
            Part(
                f"the second mode, which makes them rough, decays by {second[1]:.1f}/s in place of {second[0]:.1f}/s, the "
                f"first by {first[1].decay:.1f}/s in place of {first[0].decay:.1f}/s",
                second[1] > 1.5 * second[0],
                {
                    "second mode, plain [1/s]": second[0],
                    "second mode, damped [1/s]": second[1],
                    "first mode, plain [1/s]": first[0].decay,
                    "first mode, damped [1/s]": first[1].decay,
                },
            ),
            Part(
                f"the amplitude is smaller, {size[1]:.2f} V from peak to peak from 1.5 to 2 s in place of {size[0]:.2f} V",
                size[1] > size[0],
                {"strain, plain [V]": size[0], "strain, damped [V]": size[1]},
            ),
        ],
        "damping takes energy out. The thesis does not say where its 0.003 Nms act, and says itself that b and T_f would "
        "need other values; here they damp bending, with a Kelvin-Voigt time of 0.003 L/EI = 0.38 ms.",
        ("3.9",),
    )


def payload() -> Claim:
    """T10."""
    moving = [chapter3.moving(name) for name in ("combined", "payload")]
    stuck = [chapter3.stuck(name) for name in ("combined", "payload")]
    most = [float(np.max(np.abs(chapter3.after_pulse(name).strain))) for name in ("combined", "payload")]
    return Claim(
        "T10",
        "section 3.4, Fig. 3.10",
        "A payload of 300 g lowers the frequency, makes the oscillations larger and slower to decay.",
        [
            Part(
                f"moving {moving[0].frequency:.2f} → {moving[1].frequency:.2f} Hz, stuck {stuck[0].frequency:.3f} → "
                f"{stuck[1].frequency:.3f} Hz",
                moving[1].frequency < moving[0].frequency and stuck[1].frequency < stuck[0].frequency,
                {
                    "moving [Hz]": moving[1].frequency,
                    "stuck [Hz]": stuck[1].frequency,
                },
            ),
            Part(
                f"largest strain {most[0]:.2f} → {most[1]:.2f} V, amplitude once stuck {stuck[0].amplitude:.3f} → "
                f"{stuck[1].amplitude:.3f} V",
                most[1] > most[0] and stuck[1].amplitude > stuck[0].amplitude,
                {"largest strain [V]": most[1], "stuck amplitude [V]": stuck[1].amplitude},
            ),
            Part(
                f"decay while moving {moving[0].decay:.2f} → {moving[1].decay:.2f}/s",
                moving[1].decay < moving[0].decay,
                {"decay [1/s]": moving[1].decay},
            ),
        ],
        "more mass at the tip moves more slowly and takes longer to give its energy to the hub's viscous friction.",
        ("3.10",),
    )
