"""What the programs of benchmarks share: their options, their lines of progress and their figures at the end."""

from __future__ import annotations

import argparse
import sys
import time
from collections.abc import Callable, Iterable, Sequence
from pathlib import Path

from benchmarks.answers.figures import Figure


def parser_of(name: str, what: str | None, count: int, counted: str) -> argparse.ArgumentParser:
    """Build the parser of a benchmark whose cases are keys.

    Args:
        name: of its folder; its answers and tables go into that of `results` with this name.
        what: it does.
        count: of cases by default.
        counted: what these are.
    """
    parser = argparse.ArgumentParser(prog=f"python -m benchmarks.{name}", description=what)
    parser.add_argument("--seed", type=int, default=1, help="of the cases; below 100 for development")
    parser.add_argument("--count", type=int, default=count, help=counted)
    parser.add_argument("--jobs", type=int, default=2, help="processes")
    results = Path(__file__).resolve().parents[2] / "results" / name
    parser.add_argument("--out", type=Path, default=results, help="folder of answers and tables, by seed")
    return parser


def parsed(parser: argparse.ArgumentParser, arguments: Sequence[str]) -> argparse.Namespace:
    """Parse the arguments; a count below 1 ends the program."""
    asked = parser.parse_args(arguments)
    if asked.count < 1:
        parser.error(f"--count {asked.count}: at least 1 is needed")
    return asked


def teller() -> Callable[[str], None]:
    """Build a function that prints a line of progress behind the time since now."""
    began = time.perf_counter()

    def say(text: str) -> None:
        print(f"{time.perf_counter() - began:5.0f} s  {text}", file=sys.stderr, flush=True)

    return say


def print_figures(found: Iterable[Figure], width: int) -> None:
    """Print figures against their goals, a line each, with names of a width."""
    for figure in found:
        print(f"{figure.what:{width}} {figure.goal:>12}  {figure.text:>16}  {figure.judged}")
