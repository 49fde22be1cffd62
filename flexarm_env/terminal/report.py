"""The page of a comparison or a diagnosis, with the replays and curves on it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import flexarm_env
from flexarm_env.files import write_whole
from flexarm_env.identify.explain.comparison import Comparison
from flexarm_env.identify.explain.effect_curve import UNITS, EffectCurve, effect_curve, unexplained_curve
from flexarm_env.identify.replay.dataset import Dataset, prepare
from flexarm_env.identify.results import Diagnosis
from flexarm_env.recordings.recording import Recording
from flexarm_env.terminal.progress import Progress


def write_report(
    path: Path,
    recordings: Sequence[Recording],
    before: Comparison,
    diagnosis: Diagnosis | None,
    provenance: Mapping[str, Any],
    progress: Progress | None = None,
) -> None:
    """Write the page, whole or not at all.

    Args:
        path: of the file.
        recordings: in the order of the comparison's replays.
        before: comparison of the arm as given.
        diagnosis: of the same recordings, if there is one.
        provenance: facts by which the result can be redone.
        progress: called with the share done and the name of the step.

    Raises:
        InputError: if the file cannot be written.
    """
    write_whole(path, report(recordings, before, diagnosis, provenance, progress))


def report(
    recordings: Sequence[Recording],
    before: Comparison,
    diagnosis: Diagnosis | None,
    provenance: Mapping[str, Any],
    progress: Progress | None = None,
) -> str:
    """Make the page's HTML; arguments as those of `write_report`."""
    from flexarm_env.pictures.page import Findings, page

    report_progress = progress or (lambda done, text: None)
    after, curves, without = None, [], {}
    if diagnosis is not None and not diagnosis.recordings:
        report_progress(0.1, "replaying the corrected arm")
        after = flexarm_env.compare(diagnosis.arm, recordings, rate=before.rate)  # the pages draw all arms at the same samples
        report_progress(0.4, "drawing the effects")
        _, dataset = prepare(diagnosis.nominal, recordings, rate=before.rate)
        curves = _curves(diagnosis, dataset)
        drawn = {curve.effect for curve in curves}
        arms = {e: after.arm.without_effect(e) for e in diagnosis.effects if e not in drawn and e in after.arm.effects}
        without = {effect: flexarm_env.compare(arm, recordings, rate=before.rate) for effect, arm in arms.items()}
    report_progress(0.7, "writing the page")
    return page(Findings(before, recordings, after, diagnosis, curves, without, provenance))


def _curves(diagnosis: Diagnosis, dataset: Dataset) -> list[EffectCurve]:
    """Estimate the curves of accepted effects that act on the hub, and the unexplained torque where more is missing."""
    found = [effect_curve(diagnosis.nominal, diagnosis.arm, effect, dataset) for effect in diagnosis.effects]
    if diagnosis.verdict in ("partly", "unknown"):
        found += [unexplained_curve(diagnosis.arm, driver, dataset) for driver in UNITS]
    return [curve for curve in found if curve is not None]
