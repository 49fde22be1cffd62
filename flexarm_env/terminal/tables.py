"""Results as short tables for a person."""

from __future__ import annotations

import sys
from collections.abc import Iterable, Mapping, Sequence

import numpy as np
from rich.console import Console, RenderableType
from rich.table import Table
from rich.text import Text

from flexarm_env.identify.calibrate.estimate import Estimate
from flexarm_env.identify.explain.comparison import Comparison, Row
from flexarm_env.identify.inspect.fault import Fault
from flexarm_env.identify.results import Addition, Diagnosis, Fit
from flexarm_env.pictures import words
from flexarm_env.pictures.highlight import error_by_second
from flexarm_env.pictures.words import NOTHING, PARTS, label_of, number, unit_of
from flexarm_env.terminal.program import discard_stdout

#: Width of a table in a file or a pipe.
WIDE = 120
SHORT_RANKING = 8
#: Seconds that a line of bars shows at most.
LONGEST_LINE = 40


class _Console(Console):
    """A console with a reader that may leave: the files that a command writes after its tables are written all the same."""

    def on_broken_pipe(self) -> None:
        self.quiet = True
        discard_stdout()


def console(to_stderr: bool = False) -> Console:
    """Open the console for tables: stdout, or stderr while stdout is for JSON."""
    stream = sys.stderr if to_stderr else sys.stdout
    return _Console(file=stream, width=None if stream.isatty() else WIDE, highlight=False, soft_wrap=not stream.isatty())


def table(title: str, columns: Sequence[str], rows: Iterable[Sequence[str]]) -> Table:
    """Make a table with words in its first column and numbers in the others."""
    made = Table(title=title, title_justify="left", title_style="bold", box=None, pad_edge=False, padding=(0, 2))
    for i, column in enumerate(columns):
        made.add_column(column, justify="left" if i == 0 else "right", header_style="dim", overflow="fold")
    for row in rows:
        made.add_row(*map(Text, row))
    return made


def text_table(title: str, columns: Sequence[str], rows: Iterable[Sequence[str]]) -> Table:
    """Make a table of words."""
    made = table(title, columns, rows)
    for column in made.columns:
        column.justify = "left"
    return made


def show(out: Console, *parts: RenderableType) -> None:
    """Print parts with an empty line after each."""
    for part in parts:
        out.print(part)
        out.print()


def comparison(result: Comparison) -> list[RenderableType]:
    """Make the tables of a comparison: by signal, by regime and band, by recording."""
    pooled = [row for row in result.rows if row.recording == "all"]
    signals = words.signals_of(list(result.noise))
    each = {(row.recording, row.signal): row for row in result.rows if row.part == "all"}
    names = list(dict.fromkeys(row.recording for row in result.rows if row.recording != "all"))
    whole = "all" if len(names) != 1 else names[0]
    by_signal = [_whole(each.get((whole, signal)), signal, result.noise[signal]) for signal in signals]
    by_signal.append(["all", number(result.error), number(result.free_run), "", ""])
    found = {(row.part, row.signal): row for row in pooled}
    kinds = list(dict.fromkeys(row.part for row in pooled if row.part != "all"))
    parts = [p for p in PARTS if p in kinds] + [p for p in kinds if p not in PARTS]
    by_part = [[part, *(_error(found.get((part, s))) for s in [*signals, "all"])] for part in parts]
    lines = _over_time(result)
    by_recording = [[name, *(_error(each.get((name, s))) for s in [*signals, "all"]), lines.get(name, "")] for name in names]
    by_recording.append(["all", *(_error(each.get(("all", s))) for s in [*signals, "all"]), ""])
    heads = [*(label_of(s) for s in signals), "all"]
    tables: list[RenderableType] = [
        Text(words.comparison(result), style="bold"),
        table("Error over noise (1 is perfect)", ["signal", "windows of 1 s", "free run", "fit", "noise"], by_signal),
        table("… by regime and frequency band, windows of 1 s", ["part", *heads], by_part),
    ]
    if result.loop_rows:
        tables.append(table("In closed loop, by the stated control law", words.LOOP_HEADS, words.loop_rows(result)))
    if len(names) > 1:
        tables.append(_left(table("… by recording", ["recording", *heads, "second by second"], by_recording)))
    elif lines:
        tables.append(Text(f"Second by second: {next(iter(lines.values()))}"))
    return [*tables, *_notes(result.notes)]


def _over_time(result: Comparison) -> dict[str, str]:
    """Draw a line of bars for each recording: its error in each second, all on one scale."""
    errors = error_by_second(result.replays, result.noise)
    largest = max((value for one in errors for value in one if np.isfinite(value)), default=0.0)
    named = zip(result.replays, errors, strict=True)
    return {one.name: words.sparkline(values[:LONGEST_LINE], largest) for one, values in named}


def _left(made: Table) -> Table:
    """Align the last column of a table left."""
    made.columns[-1].justify = "left"
    return made


def _whole(row: Row | None, signal: str, noise: float) -> list[str]:
    """Make the row of a signal over all recordings."""
    label, unit = label_of(signal), unit_of(signal)
    errors = [NOTHING] * 3
    if row is not None:
        errors = [number(row.error), number(row.free_run), f"{row.fit:.1f} %" if np.isfinite(row.fit) else NOTHING]
    return [label, *errors, f"{number(noise, 2)} {unit}"]


def _error(row: Row | None) -> str:
    return NOTHING if row is None or row.samples == 0 else number(row.error)


def _notes(notes: Sequence[str]) -> list[RenderableType]:
    return [Text("\n".join(f"- {note}" for note in notes))] if notes else []


def steps(
    steps_: Sequence[tuple[str, float]], free: Sequence[tuple[str, float]], closed: Sequence[tuple[str, float]] = ()
) -> Table:
    """Make the table of the error after each step."""
    last = steps_[-1][0] if steps_ else ""
    whole = [dict(one) | {last: one[-1][1]} for one in (free, closed) if one]  # all end with the final model
    largest = max((value for _, value in steps_), default=0.0) or 1.0  # 0 where nothing moves and nothing is modelled to
    rows = [
        [name, number(value), *(number(one[name]) if name in one else NOTHING for one in whole), words.bar(value / largest)]
        for name, value in steps_
    ]
    heads = [head for head, one in (("free run", free), ("closed loop", closed)) if one]
    return _left(table("Held-out error over noise (1 is perfect)", ["step", "windows of 1 s", *heads, ""], rows))


def _closed(errors: Mapping[str, float], effects: Sequence[str] = ()) -> list[tuple[str, float]]:
    """List the errors in closed loop after each step, none where no loop is known."""
    return words.steps_of(errors, effects) if errors else []


def estimates(title: str, found: Sequence[Estimate]) -> list[RenderableType]:
    """Make the table of fitted values with their intervals and their values before."""
    return [table(title, words.ESTIMATES, words.estimate_rows(found))] if found else []


def diagnosis(result: Diagnosis) -> list[RenderableType]:
    """Show the verdict, the ranking, the error and the constants of a diagnosis, or the faults of its recordings."""
    if result.recordings:
        return [Text(words.verdict(result), style="bold"), faults(result.recordings), *_notes(result.notes)]
    free = words.steps_of(result.free_run, result.effects)
    constants = [e for e in result.constants.values() if not e.path.startswith("effects.") or e.nominal]
    return [
        Text(words.verdict(result), style="bold"),
        *_ranking(result),
        steps(words.steps_of(result.error, result.effects), free, _closed(result.closed_loop, result.effects)),
        *_budget(result),
        *estimates("Constants", constants),
        *_notes([*result.notes, *([f"to settle what is open, {result.next_run.why}"] if result.next_run else [])]),
    ]


def _budget(result: Diagnosis) -> list[RenderableType]:
    """Make the table of the error budget, in total and by signal."""
    rows, columns = words.budget_rows(result.budget), words.budget_columns(result.budget)
    return [table("Shares of the excess error (error² − 1) of the arm as given, held out", columns, rows)] if rows else []


def faults(found: Sequence[Fault]) -> Table:
    """Make the table of faults of recordings."""
    return text_table("Faults of the recordings", words.FAULT_COLUMNS, words.fault_rows(found))


def _ranking(result: Diagnosis) -> list[RenderableType]:
    probable = words.probabilities(result)
    rows = [
        [
            "✓" if c.accepted else "",
            c.effect,
            words.bar(c.gain, 8),
            f"{100 * c.gain:.0f} %",
            probable.get(c.effect, ""),
            words.parameters_of(c.estimates),
        ]
        for c in result.ranking[:SHORT_RANKING]
    ]
    if not rows:
        return []
    title = "Effects by the share of the excess error that each removes"
    if len(result.ranking) > SHORT_RANKING:
        title += f" ({SHORT_RANKING} of {len(result.ranking)}; --json FILE has all)"
    made = text_table(title, ["", "effect", "", "gain", "probability", "parameters (90 % interval)"], rows)
    for column in made.columns[3:5]:
        column.justify = "right"
    return [made]


def addition(result: Addition) -> list[RenderableType]:
    """Show the error and the values after an effect was added."""
    return [
        Text(words.addition(result), style="bold"),
        steps(
            words.steps_of(result.error, [result.effect]),
            words.steps_of(result.free_run, [result.effect]),
            _closed(result.closed_loop, [result.effect]),
        ),
        *estimates("Values", result.estimates),
        *_notes(result.notes),
    ]


def fit(result: Fit) -> list[RenderableType]:
    """Show the error and the constants after a refit."""
    return [
        Text(f"Refitted, the held-out error {words.change(result.error)}.", style="bold"),
        steps(words.steps_of(result.error), words.steps_of(result.free_run), _closed(result.closed_loop)),
        *estimates("Constants", result.estimates),
        *_notes(result.notes),
    ]
