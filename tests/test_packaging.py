"""What the package promises from outside: version, light import, declared and one-way dependencies."""

from __future__ import annotations

import ast
import importlib.metadata
import re
import subprocess
import sys
import tomllib
import zipfile
from collections.abc import Iterator
from pathlib import Path

import pytest
import yaml  # comes with pre-commit

PROJECT = Path(__file__).resolve().parent.parent
PACKAGE = "flexarm_env"
METADATA = tomllib.loads((PROJECT / "pyproject.toml").read_text(encoding="utf-8"))["project"]

HEAVY = {"torch", "stable_baselines3", "sb3_contrib", "plotly", "matplotlib", "polars", "pandas", "numba", "pygame", "nicegui"}

# A module imports from its own layer and those above it in this list.
LAYERS = (
    {"errors"},
    {"units", "parameters", "files", "cache", "generated", "display"},
    {
        "arm",
        "arm_checks",
        "arm_file",
        "arm_sections",
        "arm_text",
        "machine",
        "plant",
        "effects",
        "sensors",
        "control",
        "linear",
        "recordings",
        "thesis_drive",
    },
    {"experiments"},
    {"identify", "controllers", "tasks", "render", "env"},
    {"vector_env", "sb3", "wrappers", "pictures", "registration"},
    {"trials", "tuning"},
    {"terminal"},
    {"lab", "demo", "thesis", "rigs"},
    {"cli", "__main__"},
    {"agents", "benchmarks"},
)
RANK = {name: rank for rank, layer in enumerate(LAYERS) for name in layer}
# From here on modules are users of the package and may take names from flexarm_env itself.
USERS = RANK["terminal"]
# Beyond the layers: recordings know no arm, identify never sees the env, and controllers see observations only (and the arm
# that they believe in).
NEVER = {
    "recordings": {"arm", "arm_checks", "arm_file", "arm_sections", "arm_text", "machine", "plant", "effects", "linear"},
    "experiments": {"env", "tasks", "render"},
    "identify": {"env", "tasks", "render"},
    "controllers": {"plant", "effects", "sensors", "recordings", "experiments", "identify", "tasks", "render", "env"},
}
ONLY_IN = {
    "gymnasium": {"tasks", "render", "env"}.union(*LAYERS[RANK["env"] + 1 :]),
    "pygame": {"render"},
    "nicegui": {"lab"},
    **{name: {"sb3", "agents", "benchmarks"} for name in ("torch", "stable_baselines3", "sb3_contrib")},
}


def imported_names(file: Path, root: Path) -> Iterator[str]:
    """Yield the full dotted name of everything that a file imports, wherever in it the import stands."""
    folder = file.relative_to(root).parent.parts
    for node in ast.walk(ast.parse(file.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            parents = folder[: len(folder) - node.level + 1] if node.level else ()
            origin = [*parents, *([node.module] if node.module else [])]
            yield from (".".join([*origin, alias.name]) for alias in node.names)


def own_module(file: Path, root: Path) -> str:
    """The name in LAYERS of a file: flexarm_env/plant/beam.py is in plant, agents/train.py in agents."""
    parts = file.relative_to(root).with_suffix("").parts
    return parts[1] if parts[0] == PACKAGE else parts[0]


def complaint(importer: str, name: str) -> str | None:
    """Why the importer may not import that dotted name, or None."""
    first, _, rest = name.partition(".")
    target = rest.partition(".")[0] if first == PACKAGE else first
    if importer not in ONLY_IN.get(first, {importer}):
        return f"only {sorted(ONLY_IN[first])} may import {first}"
    if first == PACKAGE and target not in RANK:
        fine = target == "__version__" or RANK[importer] >= USERS
        return None if fine else f"import {name} from the module that defines it"
    if RANK.get(target, 0) > RANK[importer] or target in NEVER.get(importer, ()):
        return f"{importer} may not import {target}"
    return None


def wrong_imports(root: Path) -> list[str]:
    """One line for each import that points the wrong way, and for each module without a layer."""
    files = sorted(file for top in (PACKAGE, "agents", "benchmarks") for file in (root / top).rglob("*.py"))
    assert files, f"no Python files under {root}"
    lines = []
    for file in files:
        importer = own_module(file, root)
        if importer == "__init__":
            continue
        if importer not in RANK:
            lines.append(f"{file.relative_to(root)}: in no layer; give {importer!r} one in LAYERS")
            continue
        found = {complaint(importer, name) for name in imported_names(file, root)} - {None}
        lines += [f"{file.relative_to(root)}: {line}" for line in sorted(filter(None, found))]
    return lines


def test_dependencies_point_one_way():
    assert wrong_imports(PROJECT) == []


@pytest.mark.parametrize(
    ("place", "line"),
    [
        ("flexarm_env/identify/fit.py", "from flexarm_env.env import SlewEnv"),
        ("flexarm_env/identify/fit.py", "from flexarm_env import env"),
        ("flexarm_env/identify/fit.py", "from .. import env"),
        ("flexarm_env/identify/deep/fit.py", "from ...env import SlewEnv"),
        ("flexarm_env/identify/fit.py", "import flexarm_env.vector_env"),
        ("flexarm_env/recordings/formats/text.py", "from flexarm_env.arm import Arm"),
        ("flexarm_env/recordings/recording.py", "from flexarm_env.identify.fit import fit"),
        ("flexarm_env/experiments/simulate.py", "from flexarm_env.identify.fit import fit"),
        ("flexarm_env/plant/beam.py", "def f():\n    import gymnasium.spaces"),
        ("flexarm_env/plant/beam.py", "from flexarm_env import Arm"),
        ("flexarm_env/parameters.py", "from .plant.beam import matrices"),
        ("flexarm_env/controllers/pd.py", "from flexarm_env.plant import assemble"),
        ("flexarm_env/env.py", "from agents.train import main"),
        ("flexarm_env/vector_env.py", "import torch"),
        ("flexarm_env/lab/session.py", "from flexarm_env.cli import arguments"),
        ("flexarm_env/demo/story.py", "def f():\n    from flexarm_env import cli"),
        ("flexarm_env/terminal/report.py", "from flexarm_env.lab.job import Job"),
        ("flexarm_env/stray.py", "import math"),
    ],
)
def test_a_wrong_import_is_found(tmp_path, place, line):
    file = tmp_path / place
    file.parent.mkdir(parents=True)
    file.write_text(line)
    assert len(wrong_imports(tmp_path)) == 1


@pytest.mark.parametrize(
    ("place", "line"),
    [
        ("flexarm_env/identify/fit.py", "from ..plant import assemble\nfrom .compare import error"),
        ("flexarm_env/arm.py", "from flexarm_env import __version__\nfrom .effects import catalogue"),
        ("flexarm_env/sb3.py", "import torch, gymnasium\nfrom .vector_env import Batch"),
        ("agents/train.py", "import flexarm_env\nfrom flexarm_env import Arm"),
    ],
)
def test_a_right_import_passes(tmp_path, place, line):
    file = tmp_path / place
    file.parent.mkdir(parents=True)
    file.write_text(line)
    assert wrong_imports(tmp_path) == []


def test_every_import_is_declared():
    extras = METADATA["optional-dependencies"]
    requirements = [*METADATA["dependencies"], *extras["plots"], *extras["lab"], *extras["logs"]]
    requirements += [*extras["render"], *extras["train"], *extras["control"]]
    declared = {re.match(r"[\w.-]+", line)[0].lower() for line in requirements}
    installed = importlib.metadata.packages_distributions()
    files = (PROJECT / PACKAGE).rglob("*.py")
    names = {name.partition(".")[0] for file in files for name in imported_names(file, PROJECT)}
    for name in names - sys.stdlib_module_names - {PACKAGE}:
        distributions = {d.lower().replace("_", "-") for d in installed.get(name, [name])}
        assert distributions & declared, f"flexarm_env imports {name}, which pyproject.toml does not declare"


def strings_of_the_package() -> Iterator[tuple[str, str]]:
    for path in sorted((PROJECT / PACKAGE).rglob("*.py")):
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            if isinstance(node, ast.Constant) and isinstance(node.value, str):
                yield str(path.relative_to(PROJECT)), node.value


def test_no_pattern_repeats_a_group_possessively():
    # Before Python 3.11.5 such a repeat does not give back what a failed last round took; an atomic group does.
    repeat = re.compile(r"\)(?:[?*+]|\{[\d,]+\})\+")
    found = [(path, text) for path, text in strings_of_the_package() if repeat.search(text)]
    assert not found


def test_version_is_the_same_everywhere():
    import flexarm_env

    assert flexarm_env.__version__ == METADATA["version"]
    assert importlib.metadata.version(METADATA["name"]) == METADATA["version"]


def test_the_citation_is_of_this_version():
    cited = yaml.safe_load((PROJECT / "CITATION.cff").read_text(encoding="utf-8"))
    assert {"cff-version", "message", "title", "authors"} <= set(cited)
    assert (cited["cff-version"], cited["type"]) == ("1.2.0", "software")
    assert (cited["version"], cited["license"]) == (METADATA["version"], METADATA["license"])
    assert cited["authors"] == METADATA["authors"]
    (thesis,) = cited["references"]
    assert thesis["type"] == "thesis"
    assert {"authors", "title"} <= set(thesis)


def test_import_is_light():
    program = f"import sys, {PACKAGE}; print(*sorted(sys.modules))"
    run = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=True)
    modules = set(run.stdout.split())
    assert PACKAGE in modules
    assert modules & HEAVY == set()


def test_the_command_exists():
    (script,) = importlib.metadata.entry_points(group="console_scripts", name="flexarm")
    assert callable(script.load())


@pytest.mark.slow
def test_the_wheel_carries_code_and_data_and_nothing_else(tmp_path):
    build = [sys.executable, "-m", "hatchling", "build", "-t", "wheel", "-d", str(tmp_path)]
    subprocess.run(build, cwd=PROJECT, capture_output=True, check=True)
    (wheel,) = tmp_path.glob("*.whl")
    packed = {name for name in zipfile.ZipFile(wheel).namelist() if ".dist-info/" not in name}
    kinds = {".py", ".toml", ".csv", ".typed"}
    own = {f.relative_to(PROJECT) for f in (PROJECT / PACKAGE).rglob("*") if f.suffix in kinds}
    configs = {PACKAGE / f.relative_to(PROJECT) for f in (PROJECT / "configs").rglob("*.toml")}
    assert {path.as_posix() for path in own | configs} <= packed
    assert {name.partition("/")[0] for name in packed} == {PACKAGE}
