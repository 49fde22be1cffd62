"""The report: one self-contained page of a comparison or a diagnosis, with the verdict on top."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from html import escape
from typing import Any

from flexarm_env.identify.calibrate.estimate import Estimate
from flexarm_env.identify.explain.comparison import Comparison
from flexarm_env.identify.explain.effect_curve import EffectCurve
from flexarm_env.identify.results import Diagnosis
from flexarm_env.pictures import bars, effect_figures, overlays, residuals, words
from flexarm_env.pictures.document import bullets, document, figure, folded, panels, paragraph, section, table
from flexarm_env.pictures.highlight import replay_of, worst_signals
from flexarm_env.pictures.inspection_page import faults_table
from flexarm_env.pictures.provenance_section import reproduce
from flexarm_env.recordings.recording import Recording

OVER_NOISE = (
    "Held-out rms error over the noise; 1 (dotted) is perfect. Dashed boxes are the part that a step removes, crossed ones the "
    "part that it adds."
)


@dataclass(frozen=True)
class Findings:
    """Contents of a report.

    Attributes:
        before: comparison of the arm as given.
        recordings: of the machine, in the order of the comparison's replays.
        after: comparison of the corrected arm.
        diagnosis: that led to the corrected arm.
        curves: of effects that act on the hub; of the remaining torque where more is missing.
        without: comparison of the corrected arm less one new effect, by the effect's name.
        provenance: "command_line", "version", "commit" and "seed", which reproduce the report.
    """

    before: Comparison
    recordings: Sequence[Recording]
    after: Comparison | None = None
    diagnosis: Diagnosis | None = None
    curves: Sequence[EffectCurve] = ()
    without: Mapping[str, Comparison] = field(default_factory=dict)
    provenance: Mapping[str, Any] = field(default_factory=dict)


def page(found: Findings) -> str:
    """Build the page's HTML."""
    before, diagnosis = found.before, found.diagnosis
    sentence = words.comparison(before) if diagnosis is None else words.verdict(diagnosis)
    parts = [paragraph(sentence, "verdict"), _glance(found), bullets((diagnosis or before).notes)]
    if diagnosis is not None and diagnosis.recordings:
        parts.append(_faults(diagnosis))
    elif diagnosis is not None:
        parts += [_budget(diagnosis), _curves(found), _ranking(diagnosis), _falling(diagnosis), _constants(diagnosis)]
        parts += [_smallest(diagnosis), _next_run(diagnosis)]
    parts += [
        section("Where it fails", _errors(before, found.after)),
        _loop(before, found.after),
        _residuals(found),
        _recordings(found),
        _redo(found),
    ]
    title = f"Arm {before.arm.name} against {words.counted(len(before.replays), 'recording')}"
    return document(title, parts)


def page_of_faults(diagnosis: Diagnosis) -> str:
    """Build the HTML of a diagnosis whose recordings cannot be read as such, with nothing to replay."""
    title = f"Arm {diagnosis.nominal.name} against recordings at fault"
    return document(title, [paragraph(words.verdict(diagnosis), "verdict"), _faults(diagnosis)])


def _faults(diagnosis: Diagnosis) -> str:
    return section("Faults of the recordings", faults_table(diagnosis.recordings))


def _glance(found: Findings) -> str:
    drawn, where = overlays.informative_window(found.before, found.after)
    shown = [figure(drawn, "glance-where", "Where it fails", where)]
    diagnosis = found.diagnosis
    if diagnosis is not None and diagnosis.ranking:
        rivals = any(len(names) > 1 for names in diagnosis.equivalent)
        caption = "✓ accepted; ≈ indistinguishable from it in these data." if rivals else "✓ accepted."
        shown.append(figure(bars.ranking(diagnosis, 6), "glance-which", "Missing effect", caption))
    if diagnosis is not None and not diagnosis.recordings:
        steps = words.steps_of(diagnosis.error, diagnosis.effects)
        shown.append(figure(bars.waterfall(steps), "glance-fall", "Error after each step", "Held out, over the noise."))
    else:
        signal = worst_signals(found.before)[0]
        spectrum = residuals.spectrum(found.before, None, signal)
        shown.append(figure(spectrum, "glance-spectrum", "At which frequency", f"{words.label_of(signal)}; 1 is noise."))
    return panels(shown)


def _budget(diagnosis: Diagnosis) -> str:
    """Draw the shares of the excess error, and list them by signal."""
    rows = words.budget_rows(diagnosis.budget)
    if not rows:
        return ""
    drawn = figure(bars.budget(diagnosis.budget), "budget", "", "Shares sum to 100 %; left of 0, a step makes a signal worse.")
    text = (
        "Shares of the excess held-out error (error² − 1) of the arm as given, in windows of 1 s. "
        "A signal without a share had no error above the noise."
    )
    listed = table(words.budget_columns(diagnosis.budget), rows)
    return section("What explains the error", paragraph(text), drawn, listed)


def _curves(found: Findings) -> str:
    effects, rest = (_curve_figures([c for c in found.curves if bool(c.effect) is named]) for named in (True, False))
    effects += _contributions(found)
    parts = [section("The effect's curve", panels(effects, wide=True))] if effects else []
    parts += [section("Unexplained torque", panels(rest, wide=True))] if rest else []
    return "\n".join(parts)


def _curve_figures(curves: Sequence[EffectCurve]) -> list[str]:
    shown = []
    for curve in curves:
        name = curve.effect.replace("_", " ") or "unexplained torque"
        caption = (
            f"Torque on the hub estimated from the recordings, without any friction law, against {curve.driver}, "
            f"while the hub moves{'' if curve.effect else '; less the torque that the arm explains'}."
        )
        shown.append(figure(effect_figures.own_curve(curve), f"curve-{curve.effect}-{curve.driver}", name, caption))
    return shown


def _contributions(found: Findings) -> list[str]:
    shown = []
    for effect, without in found.without.items():
        assert found.after is not None
        drawn, where = effect_figures.contribution(without, found.after)
        caption = f"Residual of the corrected model without the effect, and the effect's contribution ({where})."
        shown.append(figure(drawn, f"share-{effect}", effect.replace("_", " "), caption))
    return shown


def _ranking(diagnosis: Diagnosis) -> str:
    if not diagnosis.ranking:
        return ""
    same = {name for names in diagnosis.equivalent for name in names}
    rows, probable = [], words.probabilities(diagnosis)
    for one in diagnosis.ranking:
        word = "accepted" if one.accepted else "indistinguishable from it" if one.effect in same else ""
        values = words.parameters_of(one.estimates) or words.NOTHING
        rows.append([one.effect, word, values, probable.get(one.effect, ""), f"{100 * one.gain:.0f} %"])
    columns = ["effect", "", "parameters (90 % interval)", "probability", "gain"]
    text = (
        "Gain is the share of the refitted model's excess held-out error (error² − 1) that the effect removes. "
        "Probability is the share of such answers that was right on machines whose effects are known."
    )
    return section("Which effect", paragraph(text), table(columns, rows, words=3))


def _falling(diagnosis: Diagnosis) -> str:
    shown = []
    errors = {"windows of 1 s from estimated states": diagnosis.error, "one free run": diagnosis.free_run}
    errors |= {"closed loop": diagnosis.closed_loop} if diagnosis.closed_loop else {}
    for name, error in errors.items():
        drawn = bars.waterfall(words.steps_of(error, diagnosis.effects))
        shown.append(figure(drawn, f"fall-{name}", name[0].upper() + name[1:]))
    return section("Held-out error after each step", paragraph(OVER_NOISE), panels(shown, wide=True))


def _constants(diagnosis: Diagnosis) -> str:
    values = list(diagnosis.constants.values())
    if not values:
        return ""
    drawn = bars.constant_changes(values)
    caption = "Bars are 90 % intervals. Filled: the value in the arm file lies outside. Open: it lies inside."
    parts = [] if drawn is None else [figure(drawn, "constants", "", caption)]
    return section("Constants before and after", *parts, estimates(values))


def estimates(found: Sequence[Estimate]) -> str:
    """Format a table of fitted values with intervals, beside the values as given."""
    return table(words.ESTIMATES, words.estimate_rows(found))


def _smallest(diagnosis: Diagnosis) -> str:
    rows = [
        [effect, one.parameter, words.number(one.value), words.plain_unit(one.unit)] for effect, one in diagnosis.smallest.items()
    ]
    text = "An effect below this size would not be detected in these recordings."
    return (
        section("Smallest detectable sizes", paragraph(text), table(["effect", "parameter", "size", "unit"], rows, words=2))
        if rows
        else ""
    )


def _next_run(diagnosis: Diagnosis) -> str:
    run = diagnosis.next_run
    if run is None:
        return ""
    drawn = figure(effect_figures.next_input(run), "next-run", "The command to record with")
    return section("The next run", paragraph(f"{run.why[0].upper()}{run.why[1:]}."), drawn)


def _errors(before: Comparison, after: Comparison | None) -> str:
    """Format the errors by signal and regime, before and after."""
    alone = len(before.replays) == 1
    rows = [r for r in before.rows if (r.recording == "all" or alone) and r.samples]
    later = {(r.recording, r.signal, r.part): r for r in after.rows} if after is not None else {}
    cells = []
    for r in rows:
        name = words.label_of(r.signal)
        line = [name, "all" if r.part == "all" else r.part, words.number(r.error), words.number(r.free_run)]
        new = later.get((r.recording, r.signal, r.part))
        cells.append(line + ([words.number(new.error), words.number(new.free_run)] if new else []))
    columns = ["signal", "part", "windows of 1 s", "free run"]
    if after is not None:
        columns = ["signal", "part", "as given, windows", "free run", "corrected, windows", "free run"]
    return folded("Errors over the noise by signal, regime and frequency", table(columns, cells, words=2))


def _loop(before: Comparison, after: Comparison | None) -> str:
    """Format the errors in closed loop, of the arm as given and of the corrected one."""
    if not before.loop_rows:
        return ""
    shown = [("As given", before)] + ([] if after is None else [("Corrected", after)])
    parts = [f"<h3>{name}</h3>{table(words.LOOP_HEADS, words.loop_rows(one), words=2)}" for name, one in shown]
    text = "The stated control law computes the command from the model's own readings and the recorded reference."
    return section("In closed loop", paragraph(text), *parts)


def _residuals(found: Findings) -> str:
    drivers = residuals.drivers(found.before, found.recordings)
    out = []
    for place, signal in enumerate(worst_signals(found.before)):
        label = words.label_of(signal)
        shown = []
        for driver in drivers:
            drawn = residuals.versus_driver(driver, found.before, found.after, signal)
            shown.append(figure(drawn, f"{signal}-{driver.name}", f"Against {driver.name}"))
        spectrum = residuals.spectrum(found.before, found.after, signal)
        shown.append(figure(spectrum, f"{signal}-spectrum", "As spectrum", "White noise of the sensor's size is 1 throughout."))
        grid = panels(shown, wide=True)
        out.append(f"<h3>{label}</h3>{grid}" if place == 0 else folded(f"Residuals of {label}", grid))
    text = (
        "Measured less modelled in windows of 1 s, over the noise's standard deviation σ; the grey band is ±2 σ. "
        "The signal with the largest error comes first."
    )
    return section("Residuals", paragraph(text), *out)


def _recordings(found: Findings) -> str:
    parts = []
    for old in found.before.replays:
        new = None if found.after is None else replay_of(found.after, old.name)
        drawn = overlays.signals(old, new, found.before.noise)
        parts.append(f"<h3>Recording {escape(old.name)}</h3>{figure(drawn, f'recording-{old.name}')}")
    return section("Measured against model", *parts)


def _redo(found: Findings) -> str:
    return reproduce(found.provenance, found.recordings, _settings(found.diagnosis))


def _settings(diagnosis: Diagnosis | None) -> str:
    """Name the settings of a diagnosis by their digest."""
    if diagnosis is None:
        return ""
    return paragraph(f"Settings {diagnosis.settings.digest()}; flexarm diagnose --settings prints the current ones.")
