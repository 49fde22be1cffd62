"""Compare controllers for a diagnosed arm with those for the nominal arm on the machine: python -m agents.sim_to_rig.

The machine is the independent simulator of tests/rig with something hidden. Policies are trained, and classical
controllers made and tuned, for the machine's nominal arm, that arm randomised (policies only) and the arm that `diagnose`
corrected from three recordings of the machine; all then drive the machine. Stopped, the same command goes on.
"""

from __future__ import annotations

import argparse
import json
import os
import sys
import tempfile
import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np

from agents.cells import Name, Values, compute_cells
from agents.evaluate import RATE
from agents.learning.artefact import Artefact
from agents.learning.options import Plan
from agents.learning.plan_file import read_plan
from agents.results import cells_place, origin_of, write_results
from agents.rig import drive
from agents.rig_cases import CASES, PROJECT, arm_files
from agents.rig_controllers import RETUNED, chosen, controllers_of, rehearse, retune, tuned_place
from agents.rig_report import report_of, verdict_of
from agents.train import place_of
from flexarm_env import Arm, InputError, Recording, __version__, diagnose
from flexarm_env.controllers import make_controller
from flexarm_env.files import read_json, write_whole
from flexarm_env.identify.workers import Task
from flexarm_env.tasks import TASKS
from flexarm_env.terminal.outputs import make_folder
from flexarm_env.terminal.program import Program
from flexarm_env.terminal.provenance import commit
from flexarm_env.trials.measures import MEASURES, measure
from flexarm_env.trials.rollout import Agent
from flexarm_env.trials.sets import FIRST_SEED
from tests.rig import write_case

FOLDER = PROJECT / "results" / "sim_to_rig"
#: Training plan of each kind of policy, on the machine's nominal arm; the corrected ones use the nominal plan on another arm.
PLANS: Mapping[str, str] = {"nominal": "nominal", "randomised": "randomised", "corrected": "nominal"}


def correct(case: str, place: Path, jobs: int) -> None:
    """Record a machine three times, diagnose the nominal arm against it, and keep the corrected arm and the verdict."""
    machine = CASES[case]
    with tempfile.TemporaryDirectory() as recorded:
        write_case(recorded, machine.settings, 0)
        found = diagnose(Arm.load(machine.nominal), Recording.read_all(recorded), jobs=jobs)
    place.parent.mkdir(parents=True, exist_ok=True)
    about = {"hidden": machine.effect, "settings": machine.settings, "nominal": machine.nominal.stem}
    about |= {"verdict": found.verdict, "effects": list(found.effects), "error": dict(found.error)}
    about |= {"seconds": round(found.seconds, 1), "version": __version__, "commit": commit()}
    write_whole(place.with_suffix(".json"), json.dumps(about, indent=1) + "\n")
    found.arm.save(place)


def plan_of(kind: str, case: str, folder: Path) -> tuple[Path, Plan]:
    """Look up the name and the training plan of a kind of policy for a case; cases of one nominal arm share its policies."""
    arm = arm_files(case, folder)["corrected" if kind == "corrected" else "nominal"]
    plan = read_plan(PROJECT / "configs" / "agents" / "rig" / f"{PLANS[kind]}.toml")
    return Path(f"{kind}-{arm.stem}"), replace(plan, arm=os.path.relpath(arm))


def wanted(folder: Path) -> dict[Path, Plan]:
    """List the plan of every policy by its name."""
    return dict(plan_of(kind, case, folder) for kind in PLANS for case in CASES)


def make(folder: Path, jobs: int, say: Callable[[str], None]) -> None:
    """Make the missing diagnoses, controllers and policies."""
    from agents.train import one_run

    files = {case: arm_files(case, folder) for case in CASES}
    for case, places in files.items():
        if not places["corrected"].is_file():
            say(f"diagnosing {case}")
            correct(case, places["corrected"], jobs)
    arms = dict.fromkeys(place for kind in ("nominal", "corrected") for place in (places[kind] for places in files.values()))
    for law in RETUNED:
        for arm in arms:
            if not tuned_place(folder, law, arm).is_file():
                say(f"tuning {law} on {arm.stem}")
                retune(law, Arm.load(arm), tuned_place(folder, law, arm))
    plans = wanted(folder)
    # seed by seed, so that a stopped run leaves equally many of each kind
    for seed in range(max(plan.seeds for plan in plans.values())):
        for name, plan in plans.items():
            if seed < plan.seeds:
                one_run(name, plan, seed, folder / "weights", None)


def policies_of(folder: Path, kind: str, case: str) -> list[Path]:
    """Find the stored runs of a kind, for a case."""
    name, plan = plan_of(kind, case, folder)
    return [path for seed in range(plan.seeds) if (path := place_of(folder / "weights", name, seed)).is_file()]


def drive_policies(paths: Sequence[Path], case: str, count: int) -> dict[str, np.ndarray]:
    """Let the runs of a kind of policy drive a machine: each measure (runs, episodes)."""
    return _driven([Artefact.load(path).agent() for path in paths], case, count)


def drive_controller(law: str | Path, arm: Arm, case: str, count: int) -> dict[str, np.ndarray]:
    """Let a law, or a tuned controller in a file, made for an arm, drive a machine: each measure (1, episodes)."""
    return _driven([make_controller(str(law), arm, 1.0 / RATE)], case, count)


def _driven(agents: Sequence[Agent], case: str, count: int) -> dict[str, np.ndarray]:
    task, signals = TASKS["slew"], tuple(Arm.load(CASES[case].nominal).signals)
    seen = [measure(drive(agent, task, CASES[case].settings, count, RATE, signals), task) for agent in agents]
    return {key: np.array([values[key] for values in seen]) for key in MEASURES}


def evaluate(folder: Path, cases: Sequence[str], count: int, jobs: int) -> dict[str, dict[str, Values]]:
    """Evaluate all policies and controllers on the machines: each measure (runs, episodes), by case and agent."""
    work: dict[Name, Task] = {}
    for case in cases:
        corrected = Arm.load(arm_files(case, folder)["corrected"])
        for kind in PLANS:
            work["machine", case, f"policy, {kind}"] = (drive_policies, (policies_of(folder, kind, case), case, count))
        for name, (law, arm) in controllers_of(folder, case).items():
            work["machine", case, name] = (drive_controller, (law, arm, case, count))
            work["simulation", case, name] = (rehearse, (law, arm, corrected))
    found = compute_cells(work, cells_place(folder, "sim_to_rig"), jobs)
    every = {}
    for case in cases:
        driven, rehearsed = (
            {name: values for (where, own, name), values in found.items() if (where, own) == (place, case)}
            for place in ("machine", "simulation")
        )
        every[case] = driven | {f"{law}, chosen": driven[f"{law}, {kind}"] for law, kind in chosen(rehearsed).items()}
    return every


@Program(stopped="stopped; the same command goes on")
def main(arguments: Sequence[str]) -> int:
    """Evaluate the stored policies, after making missing ones with --make, and return the exit code."""
    parser = argparse.ArgumentParser(prog="python -m agents.sim_to_rig", description=__doc__.partition("\n")[0])
    parser.add_argument("--make", action="store_true", help="first diagnose and train what is not there; stopped, it goes on")
    parser.add_argument("--count", type=int, default=20, help="episodes on each machine; 20 by default")
    parser.add_argument("--jobs", type=int, default=2, help="processes; 2 by default")
    parser.add_argument("--save", type=Path, default=FOLDER, help="folder of arms, policies and results; results/sim_to_rig")
    asked = parser.parse_args(arguments)
    began = time.perf_counter()

    def say(text: str) -> None:
        print(f"\r{time.perf_counter() - began:4.0f} s  {text:<70}", end="", file=sys.stderr, flush=True)

    if asked.count < 1 or asked.jobs < 1:
        raise InputError(f"--count {asked.count}, --jobs {asked.jobs}; give whole numbers from 1 up")
    make_folder(asked.save, "sim_to_rig.json", "sim_to_rig.md")
    if asked.make:
        make(asked.save, asked.jobs, say)
    there = [case for case in CASES if all(policies_of(asked.save, kind, case) for kind in PLANS)]
    if not there:
        raise InputError(f"no policies in {asked.save}; add --make to diagnose and train")
    values = evaluate(asked.save, there, asked.count, asked.jobs)
    told = {case: arm_files(case, asked.save)["corrected"].with_suffix(".json") for case in there}
    result = {
        **origin_of(f"python -m agents.sim_to_rig --count {asked.count}", FIRST_SEED),
        "episodes": asked.count,
        "seconds": round(time.perf_counter() - began, 1),
        "diagnoses": {case: read_json(place, "delete it, and add --make") for case, place in told.items()},
        "not_made": [case for case in CASES if case not in there],
        "cases": {case: verdict_of(found) for case, found in values.items()},
    }
    place = write_results(asked.save, "sim_to_rig", result, report_of(result))
    print(f"{place}: {result['seconds']} s")
    return 0


if __name__ == "__main__":
    sys.exit(main())
