"""The figures beside their goals, as a table and as JSON."""

from __future__ import annotations

import datetime
import json
import os
import platform
import subprocess
import tempfile
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from rich.console import Console
from rich.table import Table

import flexarm_env


@dataclass(frozen=True)
class Goal:
    """One figure and what it should be: at most `most`, or at least `least`."""

    figure: str
    text: str
    unit: str = ""
    most: float | None = None
    least: float | None = None

    def met(self, value: float) -> bool:
        """Whether a value reaches the goal."""
        return (self.most is None or value <= self.most) and (self.least is None or value >= self.least)

    def bound(self) -> str:
        """The goal in words."""
        sign, value = ("≤", self.most) if self.most is not None else ("≥", self.least)
        return f"{sign} {value:g} {self.unit}".rstrip()


GOALS = (
    Goal("base_ns", "one element, base friction: a 5 ms step", "ns", most=150),
    Goal("base_error", "… its error, over each signal's peak", most=1e-9),
    Goal("lsoda_over_plant", "… times faster than LSODA at rtol 1e-6", "×", least=150),
    Goal("dop853_over_plant", "… times faster than DOP853 with events at rtol 1e-10", "×", least=500),
    Goal("six_over_base", "four elements, six effects: a step over the one above", "×", most=8),
    Goal("six_error", "… its error against DOP853 with the same laws", most=1e-6),
    Goal("six_error_32_times_finer", "… its error against steps 32 times as short", most=1e-6),
    Goal("diagnosis_s", "diagnosis of the shipped recordings on 2 cores", "s", most=120),
    Goal("import_s", "import flexarm_env", "s", most=0.3),
    Goal("first_simulation_s", "first simulation of a fresh process, warm cache", "s", most=1.5),
)


def show(found: Mapping[str, Any]) -> None:
    """Print the table and, below it, what belongs to its figures."""
    out = Console(width=120, highlight=False, soft_wrap=True)
    table = Table(box=None, pad_edge=False, padding=(0, 2))
    for column, justify in (("", "left"), ("measured", "right"), ("goal", "right"), ("", "left")):
        table.add_column(column, justify=justify)  # type: ignore[arg-type]
    for goal in GOALS:
        value = found.get(goal.figure)
        shown = "not measured" if value is None else f"{value:.3g} {goal.unit}".rstrip()
        table.add_row(goal.text, shown, goal.bound(), "" if value is None else "met" if goal.met(value) else "MISSED")
    out.print(table)
    out.print()
    for line in remarks(found):
        out.print(line)


def remarks(found: Mapping[str, Any]) -> list[str]:
    """Sentences with what the table leaves out."""
    lines = []
    if "base_ns" in found:
        lines += [
            f"LSODA: {1e3 * found['lsoda_s']:.0f} ms for 5 s, error {found['lsoda_error']:.1g}. "
            f"DOP853: {1e3 * found['dop853_s']:.0f} ms, error {found['dop853_error']:.1g}. "
            f"Plant: {1e-3 * found['base_ns']:.3g} ms for 1000 steps. MuJoCo: {found['mujoco']}.",
            f"Reference: {found['reference']}.",
            f"Six effects: {', '.join(found['six_effects'])}; {found['six_ns']:.0f} ns a step; the median of "
            f"paired ratios is {found['six_over_base_median']:.2f}; DOP853 takes {found['six_dop853_s']:.0f} s.",
            f"Ten such pulses on end, where the arm slides most of the time: {found['six_repeated_ns']:.0f} ns a step, "
            f"{found['six_repeated_over_base']:.2f} × as long as with one element and base friction.",
        ]
    missed = [g.text.removeprefix("… ") for g in GOALS if g.figure in found and not g.met(found[g.figure])]
    lines.append(f"Missed: {'; '.join(missed)}." if missed else "Every goal that was measured is met.")
    return lines


def write(path: Path, found: Mapping[str, Any], seconds: float) -> None:
    """Write all figures with what they were measured on, whole or not at all."""
    goals = {g.figure: {"goal": g.bound(), "met": g.met(found[g.figure])} for g in GOALS if g.figure in found}
    content = {
        "command": "python -m benchmarks",
        "version": flexarm_env.__version__,
        "commit": commit(),
        "date": datetime.datetime.now(datetime.UTC).isoformat(timespec="seconds"),
        "machine": machine(),
        "seconds": seconds,
        "figures": dict(found),
        "goals": goals,
    }
    path.parent.mkdir(parents=True, exist_ok=True)
    with tempfile.NamedTemporaryFile("w", dir=path.parent, suffix=".tmp", delete=False, encoding="utf-8") as file:
        json.dump(content, file, indent=2, ensure_ascii=False)
        file.write("\n")
    os.replace(file.name, path)


def commit() -> str:
    """Commit of the source tree, with + where it has changes; "" outside of one."""
    root = Path(__file__).resolve().parent.parent
    try:
        git = ["git", "-C", str(root)]
        done = subprocess.run([*git, "rev-parse", "HEAD"], capture_output=True, text=True, check=True)
        changed = subprocess.run([*git, "status", "--porcelain"], capture_output=True, text=True, check=True)
    except (OSError, subprocess.CalledProcessError):
        return ""
    return done.stdout.strip() + ("+" if changed.stdout.strip() else "")


def machine() -> dict[str, Any]:
    """What the figures were measured on."""
    from importlib.metadata import version

    name = platform.processor()
    info = Path("/proc/cpuinfo")
    if info.is_file():
        models = [line for line in info.read_text().splitlines() if line.startswith("model name")]
        name = models[0].split(":", 1)[1].strip() if models else name
    return {
        "processor": name,
        "cores": os.cpu_count(),
        "load": os.getloadavg()[0] if hasattr(os, "getloadavg") else None,
        "system": platform.platform(),
        "python": platform.python_version(),
        **{package: version(package) for package in ("numpy", "scipy", "numba")},
    }
