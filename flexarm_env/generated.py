"""Python modules made of text, in the user's cache, each named by the hash of all that it depends on.

numba caches the machine code of such a module across processes. A change in the text gives another module, so that nothing
that was compiled of an older text is ever used.
"""

from __future__ import annotations

import atexit
import hashlib
import importlib.util
import sys
import threading
from collections.abc import Callable
from pathlib import Path
from types import ModuleType

from flexarm_env import cache
from flexarm_env.files import write_whole

#: Threads that need one module at once must get one: a second import would part the types of the first from their names.
_IMPORTING = threading.RLock()


def without_imports(path: Path) -> str:
    """Read a kernel file without its imports, which the generated module brings itself."""
    lines, skipping = [], False
    for line in path.read_text(encoding="utf-8").splitlines():
        starts = line.startswith(("from ", "import "))
        if starts:
            skipping = line.rstrip().endswith("(")
        elif skipping:
            skipping = not line.startswith(")")
        elif "= NDArray[" not in line:
            lines.append(line)
    return "\n".join(lines)


def generated_module(
    prefix: str, depends_on: str, text: Callable[[], str], notice: Callable[[], None] | None = None
) -> ModuleType:
    """Import a generated module, writing it first where it is not in the cache.

    Args:
        prefix: of the module's name.
        depends_on: all text that the module depends on, of which its name is the hash.
        text: makes the module's source.
        notice: called where nothing compiled of the module is in the cache yet.

    Raises:
        InputError: where no folder has room for what is compiled of it.
    """
    name = f"{prefix}_{hashlib.sha256(depends_on.encode()).hexdigest()[:16]}"
    with _IMPORTING:
        return sys.modules[name] if name in sys.modules else _imported(name, text, notice)


def _imported(name: str, text: Callable[[], str], notice: Callable[[], None] | None) -> ModuleType:
    folder = cache.cache_folder(name)
    cache.remove_damaged(folder, name)
    was_there = (folder / f"{name}.py").exists()
    try:
        module = _executed(folder, name, text, notice)
    except Exception as error:
        # What numba does not compile is a fault of the text. Anything else, in a module that was read, is damage in the cache.
        if not was_there or type(error).__module__.startswith("numba"):
            raise
        cache.forget(folder, name)
        module = _executed(folder, name, text, notice)
    cache.record(folder, name)
    atexit.register(cache.record, folder, name)  # some kernels are compiled at their first call
    return module


def _executed(folder: Path, name: str, text: Callable[[], str], notice: Callable[[], None] | None) -> ModuleType:
    path = folder / f"{name}.py"
    if not path.exists():
        write_whole(path, text())
    if notice and not cache.is_compiled(folder, name):
        notice()
    spec = importlib.util.spec_from_file_location(name, path)
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    sys.modules[name] = module
    try:
        spec.loader.exec_module(module)
    except BaseException:
        del sys.modules[name]
        raise
    return module
