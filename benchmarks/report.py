"""The figures beside their goals, as a table and as JSON."""

from __future__ import annotations

import datetime
import json
import os
import platform
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from rich.console import Console
from rich.table import Table

import flexarm_env
from flexarm_env.files import write_whole
from flexarm_env.terminal.provenance import commit


@dataclass(frozen=True)
class Goal:
    """One figure with its goal: at most `most`, or at least `least`."""

    figure: str
    text: str
    unit: str = ""
    most: float | None = None
    least: float | None = None

    def met(self, value: float) -> bool:
        """Whether a value reaches the goal."""
        return (self.most is None or value <= self.most) and (self.least is None or value >= self.least)

    def bound(self) -> str:
        """Format the goal in words."""
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
    Goal("jacobian_over_replay", "derivatives by twelve constants over a corrected replay, largest of six", "×", most=3),
    Goal("nothing_and_parameters_longest_s", "diagnosis on 2 cores: nothing missing, wrong constants", "s", most=4),
    Goal("one_effect_median_s", "… one effect, median", "s", most=10),
    Goal("one_effect_longest_s", "… one effect, longest", "s", most=15),
    Goal("two_effects_longest_s", "… two effects", "s", most=30),
    Goal("outside_the_catalogue_longest_s", "… outside the catalogue", "s", most=20),
    Goal("rigid_axis_longest_s", "… a rigid axis, two recordings", "s", most=3),
    Goal("import_s", "import flexarm_env", "s", most=0.3),
    Goal("first_simulation_s", "first simulation of a fresh process, warm cache", "s", most=1.5),
    Goal("reading_ms", "reading a recording of 5000 rows", "ms", most=50),
    Goal("lab_replays_ms", "three recordings of 10 s simulated anew as a slider of the lab moves", "ms", most=100),
    Goal("single_over_pendulum", "one arm over Gymnasium's Pendulum-v1, steps per second", "×", least=3),
    Goal("smooth_over_envpool", "1024 arms over EnvPool's Pendulum-v1, one thread, smooth actions", "×", least=3),
    Goal("white_over_envpool", "… white noise", "×", least=1.5),
    Goal("mujoco_over_batch", "… over MuJoCo's 4 segments at 1 ms, smooth actions", "×", least=25),
    Goal("threads_smooth", "… two threads over one, smooth actions", "×", least=1.7),
    Goal("faults_named_percent", "faults of recordings named right", "%", least=97),
    Goal("faults_false_alarms", "false alarms on sound recordings", most=0),
    Goal("inspection_s", "inspection of three recordings of 10 s", "s", most=1),
    Goal("scale_out", "two workers of a cluster over one, independent diagnoses", "×", least=1.8),
    Goal("ppo_env_percent", "share of PPO's time that the environments take", "%", most=5),
)


def show(found: Mapping[str, Any]) -> None:
    """Print the table and, below it, remarks on its figures."""
    out = Console(width=120, highlight=False, soft_wrap=True)
    table = Table(box=None, pad_edge=False, padding=(0, 2))
    for column, justify in (("", "left"), ("measured", "right"), ("goal", "right"), ("", "left")):
        table.add_column(column, justify=justify)  # type: ignore[arg-type]
    for goal in GOALS:
        value = found.get(goal.figure)
        absent = "not installed" if goal.figure in found else "not measured"
        shown = absent if value is None else f"{value:.3g} {goal.unit}".rstrip()
        table.add_row(goal.text, shown, goal.bound(), "" if value is None else "met" if goal.met(value) else "MISSED")
    out.print(table)
    out.print()
    for line in remarks(found):
        out.print(line)


def remarks(found: Mapping[str, Any]) -> list[str]:
    """Write sentences on facts that the table omits."""
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
    if "scale_out" in found:
        lines.append(
            f"Two workers: {found['scale_out']:.2f} × (median of the turns), where hashes alone got "
            f"{found['scale_out_possible']:.2f} ×."
        )
    if "single_over_pendulum" in found:
        lines += about_environments(found)
    measured = [g for g in GOALS if found.get(g.figure) is not None]
    missed = [g.text.removeprefix("… ") for g in measured if not g.met(found[g.figure])]
    lines.append(f"Missed: {'; '.join(missed)}." if missed else "Every goal that was measured is met.")
    return lines


def about_environments(found: Mapping[str, Any]) -> list[str]:
    """Write sentences on the environments: steps per second, medians of pairs, and the load of the machine."""
    millions = {name: (found[f"batch_{name}_per_s"] or 0.0) / 1e6 for name in ("smooth", "white", "envpool")}
    lines = [
        f"One arm: {found['single_ours_per_s']:.0f} steps/s, Pendulum-v1 {found['single_pendulum_per_s']:.0f}; the median "
        f"of paired ratios is {found['single_over_pendulum_median']:.2f}.",
        f"1024 arms: {millions['smooth']:.2f} million steps/s under smooth actions, {millions['white']:.2f} under white noise.",
    ]
    if found["envpool"] is not None:
        lines.append(
            f"EnvPool {found['envpool']}: {millions['envpool']:.2f} million steps/s; the medians of paired ratios are "
            f"{found['smooth_over_envpool_median']:.2f} and {found['white_over_envpool_median']:.2f}."
        )
    if found["mujoco_us"] is not None:
        friction = ", ".join(f'{key}="{value}"' for key, value in found["mujoco_friction"].items())
        lines.append(
            f"MuJoCo: {found['mujoco_us']:.1f} µs an arm and step of 5 ms; with {friction} a push of 70 % of what friction "
            f"holds moves its hub by {found['mujoco_creep']:.2g} rad in 5 s, by {found['mujoco_creep_default']:.2g} rad "
            f"with MuJoCo's defaults; ours stays."
        )
    lines.append(
        f"Two threads: {found['threads_smooth']:.2f} × under smooth actions, {found['threads_white']:.2f} under white noise "
        f"(medians {found['threads_smooth_median']:.2f} and {found['threads_white_median']:.2f}), where hashes alone got "
        f"{found['threads_possible']:.2f} × (median {found['threads_possible_median']:.2f}); load {found['threads_load']:.1f}."
    )
    if found["ppo_env_percent"] is not None:
        lines.append(f"PPO: {found['ppo_samples_per_s']:.0f} samples/s, updates included, torch on one thread.")
    return lines


def origin(command: str) -> dict[str, Any]:
    """Gather what stands in every record: the command, version and commit, the time and the machine."""
    return {
        "command": command,
        "version": flexarm_env.__version__,
        "commit": commit(),
        "date": datetime.datetime.now(datetime.UTC).isoformat(timespec="seconds"),
        "machine": machine(),
    }


def write(path: Path, found: Mapping[str, Any], seconds: float) -> None:
    """Write all figures and the machine that they were measured on, atomically."""
    measured = [g for g in GOALS if found.get(g.figure) is not None]
    goals = {g.figure: {"goal": g.bound(), "met": g.met(found[g.figure])} for g in measured}
    content = origin("python -m benchmarks") | {"seconds": seconds, "figures": dict(found), "goals": goals}
    path.parent.mkdir(parents=True, exist_ok=True)
    write_whole(path, json.dumps(content, indent=2, ensure_ascii=False) + "\n")


def machine() -> dict[str, Any]:
    """Describe the machine that the figures are measured on."""
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
