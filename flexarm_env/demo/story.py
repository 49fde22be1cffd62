"""The loop on the shipped recordings: compare, diagnose, add, compare. Numbers and pictures go to a folder."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from rich.console import Console
from rich.text import Text

from flexarm_env.arm import Arm
from flexarm_env.identify.explain.comparison import Comparison
from flexarm_env.identify.results import Addition, Diagnosis
from flexarm_env.pictures import words
from flexarm_env.recordings.recording import Recording
from flexarm_env.terminal import identification, outputs, plain_data, tables
from flexarm_env.terminal.provenance import provenance

ARM = "thesis-fem"
JOBS = 2
#: The effect that the independent simulator put into the recordings; read only after the diagnosis, for the last line.
HIDDEN = ("backlash", "gap", 0.06, "rad")


def run_demo(output: Path, seed: int = 0, json: Path | None = None) -> bool:
    """Run the demonstration; return whether an effect was found.

    Args:
        output: folder for pictures, page and numbers; it is created.
        seed: of all random numbers.
        json: a second file for the numbers.

    Raises:
        InputError: if the folder cannot be made or written.
    """
    outputs.make_folder(output, "demo.json")
    out = tables.console(to_stderr=json == outputs.STDOUT)
    arm = Arm.load(ARM)
    recordings = Recording.read_all(Path(__file__).parent)
    before = identification.compare(arm, recordings)
    _heading(out, f"flexarm compare RECORDINGS --arm {ARM}", words.comparison(before))
    diagnosis = identification.diagnose(arm, recordings, seed, JOBS)
    _heading(out, f"flexarm diagnose RECORDINGS --arm {ARM}", words.verdict(diagnosis))
    content: dict[str, Any] = {"compare": plain_data.of_comparison(before), "diagnose": diagnosis.as_json()}
    added, after = None, identification.compare(diagnosis.arm, recordings)
    if diagnosis.effects:
        added = identification.add(diagnosis.effects[0], arm, recordings, seed)
        after = identification.compare(added.arm, recordings)
        _heading(out, f"flexarm add {added.effect} RECORDINGS --arm {ARM}", words.addition(added))
        tables.show(out, tables.steps(*_steps(added)))
        _heading(out, "flexarm compare RECORDINGS --arm THE-NEW-ARM", words.comparison(after))
        content |= {"add": plain_data.of_addition(added), "compare_after": plain_data.of_comparison(after)}
    out.print(Text(_compare_with_truth(added)))
    origin = provenance("demo", ARM, recordings, seed)
    page = output / "report.html"
    command = {"command_line": f"flexarm diagnose flexarm_env/demo --arm {ARM} --seed {seed}"}
    identification.write_page(page, recordings, before, diagnosis, origin | command)
    made = [*_draw(output, before, after, diagnosis), page]
    content |= origin
    outputs.write_json(output / "demo.json", content)
    outputs.write_json(json, content)
    out.print(Text(f"In {output}: {', '.join(path.name for path in [*made, output / 'demo.json'])}"))
    return added is not None and added.error["final"] < added.error["refitted"]


def _heading(out: Console, command: str, sentence: str) -> None:
    tables.show(out, Text.assemble((f"$ {command}\n", "dim"), (sentence, "bold")))


def _steps(added: Addition) -> tuple[list[tuple[str, float]], list[tuple[str, float]]]:
    return words.steps_of(added.error, [added.effect]), words.steps_of(added.free_run, [added.effect])


def _compare_with_truth(added: Addition | None) -> str:
    """Write the hidden effect beside the estimate."""
    effect, parameter, size, unit = HIDDEN
    made = "The hidden effect, put in by a simulator that shares no code with this"
    hidden = f"{made}, was {effect}, {parameter} = {size} {unit}."
    found = None
    if added is not None and added.effect == effect:
        found = next((e for e in added.estimates if e.path == f"effects.{effect}.{parameter}"), None)
    return hidden if found is None else f"{hidden} The estimate is {words.value_of(found)}."


def _draw(output: Path, before: Comparison, after: Comparison, diagnosis: Diagnosis) -> list[Path]:
    """Write the pictures; return their paths."""
    from flexarm_env.pictures import curves

    names = ("as given", f"with {' and '.join(diagnosis.effects)}" if diagnosis.effects else "refitted")
    steps = words.steps_of(diagnosis.error, diagnosis.effects)
    free = words.steps_of(diagnosis.free_run, diagnosis.effects)
    return [
        *curves.save(curves.loop(before, after, diagnosis), output / "loop"),
        *curves.save(curves.overlay(before, after, "square", names), output / "overlay"),
        *curves.save(curves.waterfall(steps, free), output / "waterfall"),
    ]
