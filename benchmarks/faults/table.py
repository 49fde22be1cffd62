"""The published table of named faults, as Markdown and as JSON."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import flexarm_env
from benchmarks.faults.inject import INJECTIONS
from benchmarks.report import machine
from flexarm_env.files import write_whole
from flexarm_env.terminal.provenance import commit

RESULTS = Path(__file__).resolve().parents[2] / "results" / "faults"


def markdown(answers: Sequence[Mapping[str, Any]], figures: Mapping[str, Any], made: str) -> str:
    """Format the share of faults named right, by kind, and the false alarms."""
    lines = ["# Faults of recordings", "", made, "", "| fault | named right | of |", "|---|---:|---:|"]
    for kind in (*INJECTIONS, "restart"):
        own = [answer["right"] for answer in answers if answer["truth"]["kind"] == kind]
        lines.append(f"| {kind} | {sum(own)} | {len(own)} |")
    lines.append(f"| all | {sum(answer['right'] for answer in answers)} | {len(answers)} |")
    sound = f"{figures['faults_false_alarms']} of {figures['faults_sound_sets']} sets of sound recordings"
    lines += ["", "A fault is named right where its kind, its signal and its size (within 2 %) are, and no other is named."]
    lines += [f"False alarms: {sound}. An inspection of three recordings of 10 s takes {figures['inspection_s']:.2g} s."]
    return "\n".join(lines) + "\n"


def write(
    seed: int,
    count: int,
    answers: Sequence[Mapping[str, Any]],
    alarms: Sequence[Mapping[str, str]],
    figures: Mapping[str, Any],
) -> Path:
    """Write table.md and table.json of a seed; return their folder."""
    folder = RESULTS / f"seed-{seed}"
    folder.mkdir(parents=True, exist_ok=True)
    command = f"python -m benchmarks --faults --seed {seed} --count {count}"
    stamp = {"command": command, "version": flexarm_env.__version__, "commit": commit(), "seed": seed, "machine": machine()}
    made = f"FlexArm {stamp['version']}, commit {stamp['commit']}: `{command}`"
    write_whole(folder / "table.md", markdown(answers, figures, made))
    content = stamp | {"figures": dict(figures), "answers": list(answers), "alarms": list(alarms)}
    write_whole(folder / "table.json", json.dumps(content, indent=1) + "\n")
    return folder
