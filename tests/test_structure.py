"""The structure of the package: no circle of imports, no tuned number outside the settings, values that nobody changes."""

from __future__ import annotations

import ast
from collections.abc import Iterator
from pathlib import Path

import pytest
from test_packaging import PACKAGE, PROJECT, imported_names

FILES = {
    ".".join(file.relative_to(PROJECT).with_suffix("").parts).removesuffix(".__init__"): file
    for file in sorted((PROJECT / PACKAGE).rglob("*.py"))
}
IDENTIFY = [file for file in FILES.values() if "identify" in file.parts]
SETTINGS = PROJECT / PACKAGE / "identify" / "settings"
SEARCH = [file for file in IDENTIFY if "select" in file.parts]

#: Layers of identify, from below; a file imports from its own layer and those above it in this list.
IDENTIFY_LAYERS = (
    {"deadline", "settings", "progress", "threads", "workers", "percent"},
    {"replay"},
    {"calibrate"},
    {"select"},
    {"inspect"},
    {"explain"},
    {"results", "origin"},
    {"fit", "conclude"},
    {"diagnose"},
)
#: Numbers that tune nothing.
PLAIN = {0.0, 0.5, 1.0, 2.0}
#: Floats of physics or of numerics in identify, beside the settings: none is needed so far.
ALLOWED: set[float] = set()
MOST_PARAMETERS, MOST_OF_A_KERNEL, MOST_SUCH_KERNELS = 8, 10, 5
MOST_ATTRIBUTES = 6


def tree(file: Path) -> ast.Module:
    return ast.parse(file.read_text(encoding="utf-8"))


def runtime_imports(file: Path) -> set[str]:
    """Modules of the package that a file imports when it runs, wherever in it the import stands."""
    module = tree(file)
    typing_only = {
        node
        for branch in ast.walk(module)
        if isinstance(branch, ast.If) and ast.unparse(branch.test) == "TYPE_CHECKING"
        for node in ast.walk(branch)
    }
    found = set()
    for node in ast.walk(module):
        if node not in typing_only and isinstance(node, ast.ImportFrom) and node.module:
            found |= {f"{node.module}.{alias.name}" for alias in node.names} | {node.module}
        elif node not in typing_only and isinstance(node, ast.Import):
            found |= {alias.name for alias in node.names}
    longest = {name for name in found if name in FILES}
    return longest - {name.rpartition(".")[0] for name in longest} - {PACKAGE}


def circles(graph: dict[str, set[str]]) -> list[set[str]]:
    """Groups of nodes that reach each other."""
    reached: dict[str, set[str]] = {}
    for start in graph:
        seen, todo = set(), [start]
        while todo:
            for following in graph.get(todo.pop(), set()) - seen:
                seen.add(following)
                todo.append(following)
        reached[start] = seen
    groups = [{other for other in reached[node] if node in reached.get(other, set())} for node in graph if node in reached[node]]
    return [group for place, group in enumerate(groups) if group not in groups[:place]]


def test_no_circle_of_files():
    assert circles({name: runtime_imports(file) - {name} for name, file in FILES.items() if name != PACKAGE}) == []


def test_no_circle_of_folders():
    """A folder of files is one room; in a folder of folders each file is one."""
    with_folders = {file.parent.parent for file in FILES.values()}

    def room(name: str) -> str:
        folder = FILES[name].parent
        return name if folder in with_folders else str(folder.relative_to(PROJECT))

    graph: dict[str, set[str]] = {}
    for name, file in FILES.items():
        if name != PACKAGE:
            graph.setdefault(room(name), set()).update(room(other) for other in runtime_imports(file) - {name})
    for name, others in graph.items():
        others.discard(name)
    assert circles(graph) == []


def test_circles_are_found():
    assert circles({"a": {"b"}, "b": {"c"}, "c": {"b"}, "d": set()}) == [{"b", "c"}]


def layer(name: str) -> int | None:
    """Number of the layer of a module of identify."""
    parts = name.split(".")
    if parts[:2] != [PACKAGE, "identify"] or len(parts) < 3:
        return None
    return next(number for number, modules in enumerate(IDENTIFY_LAYERS) if parts[2] in modules)


def test_imports_of_identify_point_one_way():
    wrong = []
    for name, file in FILES.items():
        own = layer(name)
        for other in imported_names(file, PROJECT) if own is not None else ():
            theirs = layer(other)
            if theirs is not None and theirs > own:
                wrong.append(f"{name} imports {other}")
    assert wrong == []


@pytest.mark.parametrize("file", [f for f in IDENTIFY if f.parent != SETTINGS], ids=lambda f: f"{f.parent.name}/{f.stem}")
def test_no_number_of_the_method_stands_outside_the_settings(file):
    floats = [node for node in ast.walk(tree(file)) if isinstance(node, ast.Constant) and isinstance(node.value, float)]
    assert {node.value for node in floats} <= PLAIN | ALLOWED
    assert len(ALLOWED) <= 20


def assigned(function: ast.AST) -> Iterator[str]:
    """Attributes that a function assigns."""
    for node in ast.walk(function):
        targets = node.targets if isinstance(node, ast.Assign) else []
        targets = [node.target] if isinstance(node, ast.AugAssign | ast.AnnAssign) else targets
        for target in targets:
            for part in ast.walk(target):
                if isinstance(part, ast.Attribute) and isinstance(part.ctx, ast.Store):
                    yield ast.unparse(part)


@pytest.mark.parametrize("file", IDENTIFY, ids=lambda f: f"{f.parent.name}/{f.stem}")
def test_identify_changes_no_attribute(file):
    """Outside constructors; and no frozen value is changed behind its back."""
    module = tree(file)
    functions = [node for node in ast.walk(module) if isinstance(node, ast.FunctionDef)]
    changed = [name for function in functions if function.name != "__init__" for name in assigned(function)]
    assert changed == []
    assert "object.__setattr__" not in ast.unparse(module)


def test_values_of_identify_are_frozen():
    loose = [
        f"{file.name}: {node.name}"
        for file in IDENTIFY
        for node in ast.walk(tree(file))
        if isinstance(node, ast.ClassDef)
        and not any("Protocol" in ast.unparse(base) for base in node.bases)
        and not any("frozen=True" in ast.unparse(decorator) for decorator in node.decorator_list)
    ]
    assert loose == []


def test_no_class_of_the_search_has_many_attributes():
    classes = [(file.name, node) for file in SEARCH for node in ast.walk(tree(file)) if isinstance(node, ast.ClassDef)]
    sizes = {f"{name}: {node.name}": sum(isinstance(part, ast.AnnAssign) for part in node.body) for name, node in classes}
    assert {name: size for name, size in sizes.items() if size > MOST_ATTRIBUTES} == {}
    assert sizes


def parameters_of(function: ast.FunctionDef | ast.AsyncFunctionDef) -> int:
    taken = function.args
    names = [one.arg for one in (*taken.posonlyargs, *taken.args, *taken.kwonlyargs)]
    return len([name for name in names if name not in ("self", "cls")])


#: Functions that people call with keywords, or that are commands.
PUBLIC = {"cli/app.py", "controllers/vibration.py", "env/flexarm.py", "vector_env.py", "identify/fit.py", "identify/diagnose.py"}


def test_no_function_takes_many_parameters():
    wide = {}
    for file in FILES.values():
        place = file.relative_to(PROJECT / PACKAGE).as_posix()
        for node in ast.walk(tree(file)):
            if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef) and place not in PUBLIC:
                count = parameters_of(node)
                if count > MOST_PARAMETERS:
                    wide[f"{place}: {node.name}"] = count
    assert len(wide) <= MOST_SUCH_KERNELS, wide
    assert all(name.startswith("plant/") and count <= MOST_OF_A_KERNEL for name, count in wide.items()), wide
