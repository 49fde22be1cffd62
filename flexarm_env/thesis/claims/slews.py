"""Rows T17 and T18: vibration suppression beside PD, over 100°."""

from __future__ import annotations

from flexarm_env.thesis.claims.claim import Claim, Part
from flexarm_env.thesis.runs import DURATION
from flexarm_env.thesis.suppression import GAINS, practical, slew, stand_in, swing

NAMES = {
    "pd": "PD alone",
    "vibration_dual": "combined",
    "vibration_low": "low speed only",
    "vibration_high": "high speed only",
}


def slew_of_100_degrees() -> Claim:
    """T17."""
    found = {name: slew(name) for name in GAINS}
    angle = {name: made.angle[-1] for name, made in found.items()}
    left = {name: made.rms(4.0, DURATION) for name, made in found.items()}
    rest = {name: made.rest() for name, made in found.items()}

    def words(name: str) -> str:
        return f"{NAMES[name]} {angle[name]:.1f}° and {1e3 * left[name]:.1f} mV"

    def numbers(name: str) -> dict[str, float]:
        return {f"{NAMES[name]} [°]": float(angle[name]), f"{NAMES[name]} [V]": left[name]}

    return Claim(
        "T17",
        "section 4.5, Figs. 4.15 to 4.19",
        "100° under PD: combined and high-speed suppression leave less vibration once the hub rests and more steady-state "
        "error; at low speed only, the error is that of PD alone and the vibration is less, which is the best result; "
        "compensation overcompensates.",
        [
            Part(
                f"{words('pd')} of strain, rms over the fifth second; {words('vibration_dual')}",
                left["vibration_dual"] < 0.8 * left["pd"] and angle["vibration_dual"] < angle["pd"],
                numbers("pd") | numbers("vibration_dual"),
            ),
            Part(
                words("vibration_high"),
                left["vibration_high"] < 0.8 * left["pd"] and angle["vibration_high"] < angle["pd"],
                numbers("vibration_high"),
            ),
            Part(
                f"{words('vibration_low')}: the error is that of PD, but so is the vibration",
                abs(angle["vibration_low"] - angle["pd"]) < 1.0 and left["vibration_low"] < 0.8 * left["pd"],
                numbers("vibration_low"),
            ),
            Part(
                f"PD's hub rests from {rest['pd']:.2f} s on, that of low speed only from {rest['vibration_low']:.2f} s; "
                "the combined controller's still moves at 5 s",
                rest["vibration_dual"] == float("inf") and rest["vibration_low"] > rest["pd"],
                {"PD rests from [s]": rest["pd"], "low speed only rests from [s]": rest["vibration_low"]},
            ),
        ],
        "before the hub rests there is too little time at low speed to damp in. How the switching at zero speed falls "
        "decides what is left: sampled at 1 ms, low speed only leaves half of it, at 0.5 ms it ends at 95.5°. High-speed "
        "suppression alone does nearly all of the work, and is the best of the four.",
        ("4.15", "4.16", "4.17", "4.18", "4.19"),
    )


def practical_choice() -> Claim:
    """T18."""
    quiet = {"pd": slew("pd"), "practical": practical()}
    noisy = {name: stand_in(name) for name in ("pd", "vibration_practical")}
    parts = []
    for label, runs, interval in (("consistent model", quiet, 0.001), ("stand-in for the rig, with noise", noisy, 0.005)):
        left = [swing(made.strain, 4.0, 5.0, interval) for made in runs.values()]
        error = [100.0 - float(made.angle[-1]) for made in runs.values()]
        parts.append(
            Part(
                f"{label}: {left[0]:.3f} → {left[1]:.3f} V from peak to peak in the fifth second, error {error[0]:.1f} → "
                f"{error[1]:.1f}°",
                left[1] < left[0] and error[1] > error[0],
                {
                    f"{label}, PD [V]": left[0],
                    f"{label} [V]": left[1],
                    f"{label}, PD [° of error]": error[0],
                    f"{label} [° of error]": error[1],
                },
            )
        )
    return Claim(
        "T18",
        "section 4.5, Figs. 4.20 to 4.22",
        "The practical choice, at high speed only and with the gage at mid-beam × K = 1.18 in place of M_o, leaves less "
        "vibration and more steady-state error.",
        parts,
        "K has no printed unit. In A/V it does what Fig. 4.21 shows; as Nm/V the loop swings between the limits of the "
        "current. The term adds to the drive while the arm speeds up and takes from it while it slows down, so the hub "
        "stops earlier.",
        ("4.20", "4.21", "4.22"),
    )
