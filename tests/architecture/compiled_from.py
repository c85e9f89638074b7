"""Finds the files that kernels are compiled from, by following what their functions name."""

from __future__ import annotations

import ast
import inspect
import sys
from collections.abc import Iterable, Iterator
from functools import cache
from pathlib import Path
from types import CodeType, FunctionType, ModuleType
from typing import Any

ROOT = Path(__file__).parents[2]
PACKAGES = ("plant_models", "scripts", "synth", "tuning_tables")


def compiled_from(modules: Iterable[ModuleType]) -> set[str]:
    """The files of our packages that hold the functions and constants which kernels in `modules` use.

    Kernels are recognised by their `py_func`. Names are resolved as the compiler does it: among the globals of the
    function, and as attributes of modules.
    """
    waiting = [function for module in modules for value in vars(module).values() if (function := plain(value))]
    seen: set[FunctionType] = set()
    files: set[Path] = set()
    while waiting:
        function = waiting.pop()
        if function in seen:
            continue
        seen.add(function)
        files.add(Path(function.__code__.co_filename))
        for name, value, where in used_by(function):
            if (called := plain(value) or (value if isinstance(value, FunctionType) else None)) is not None:
                waiting.append(called)
            elif isinstance(value, type):
                files.add(file_of(sys.modules[value.__module__]))
            elif not isinstance(value, ModuleType):
                files.add(definer(name, where))
    return {file.relative_to(ROOT).as_posix() for file in files if is_ours(file)}


def plain(value: Any) -> FunctionType | None:
    """The function that the kernel `value` is compiled from; None if it is no kernel."""
    found = getattr(value, "py_func", None)
    return found if isinstance(found, FunctionType) else None


def used_by(function: FunctionType) -> Iterator[tuple[str, Any, ModuleType]]:
    """(name, value, module that it was looked up in) of every global that `function` names, modules followed."""
    names = list(names_in(function.__code__))
    home = sys.modules[function.__module__]
    found = [(name, function.__globals__[name], home) for name in names if name in function.__globals__]
    for name, value, where in found:
        yield name, value, where
        if isinstance(value, ModuleType) and is_ours(file_of(value)):
            found += [(part, getattr(value, part), value) for part in names if hasattr(value, part)]


def names_in(code: CodeType) -> Iterator[str]:
    """The names of globals and attributes in a function and in those defined inside it."""
    yield from code.co_names
    for constant in code.co_consts:
        if isinstance(constant, CodeType):
            yield from names_in(constant)


def definer(name: str, module: ModuleType) -> Path:
    """The file that gives the constant `name` its value: that of `module`, or where it was imported from."""
    for node in top_of(module):
        if isinstance(node, ast.ImportFrom) and node.module and not node.level:
            for alias in node.names:
                if (alias.asname or alias.name) == name and (source := sys.modules.get(node.module)) is not None:
                    return definer(alias.name, source)
    return file_of(module)


@cache
def top_of(module: ModuleType) -> tuple[ast.stmt, ...]:
    """The statements at the top of its source; none where it has no source."""
    try:
        return tuple(ast.parse(inspect.getsource(module)).body)
    except (OSError, TypeError):
        return ()


def is_ours(file: Path) -> bool:
    """Whether a file is a source of one of the packages."""
    return any(file.is_relative_to(ROOT / package) for package in PACKAGES)


def file_of(module: ModuleType) -> Path:
    """Its source; an empty path where it has none."""
    return Path(getattr(module, "__file__", None) or "")
