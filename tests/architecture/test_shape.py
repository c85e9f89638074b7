"""The shape of the house: few rooms, short files and functions, few arguments, and nothing that no command reaches.

Every rule is a function from sources to offences, and a planted offence shows that it finds some. `KNOWN` names what
still offends: it may only become shorter, for a name that no longer offends fails the test too.
"""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator, Mapping
from functools import cache
from pathlib import Path
from typing import NamedTuple

import pytest

ROOT = Path(__file__).parents[2]
PACKAGES = ("plant_models", "scripts", "synth", "tuning_tables")
SOURCES = {
    path.relative_to(ROOT).as_posix(): path.read_text(encoding="utf-8")
    for package in PACKAGES
    for path in sorted((ROOT / package).rglob("*.py"))
}
DECLARED = {path.relative_to(ROOT).as_posix(): path.read_text(encoding="utf-8") for path in ROOT.glob("synth/**/*.pyi")}
"""Stubs: what the packages beside them import when it is first used."""

MOST_ROOMS = 13
MOST_LINES, MOST_FUNCTION_LINES, MOST_ARGUMENTS = 300, 60, 8
KERNEL_ARGUMENTS = 12
"""What a kernel may have, and one has; lower it when that one has fewer."""

KNOWN: set[str] = set()
KNOWN_UNREACHED: set[str] = set()

Function = ast.FunctionDef | ast.AsyncFunctionDef

ENTRY = re.compile(r"[a-z]\w*(\.[a-z]\w*)+:[A-Za-z]\w*")


def test_there_are_packages_to_judge() -> None:
    assert {name.partition("/")[0] for name in SOURCES} == set(PACKAGES)
    assert len(SOURCES) > 200


def decorators(node: ast.ClassDef) -> list[str]:
    """The decorators of a class, as text."""
    return [ast.unparse(decorator) for decorator in node.decorator_list]


def rooms(sources: Mapping[str, str]) -> set[str]:
    """Packages and modules at the top of `synth`."""
    parts = [name.split("/")[1].removesuffix(".py") for name in sources if name.startswith("synth/")]
    return set(parts) - {"__init__"}


def test_synth_has_few_rooms() -> None:
    assert len(rooms(SOURCES)) <= MOST_ROOMS
    assert rooms({"synth/__init__.py": "", "synth/a.py": "", "synth/b/c.py": "", "synth/b/d.py": ""}) == {"a", "b"}


def long_files(sources: Mapping[str, str]) -> Iterator[str]:
    """Files with more lines than a file may have."""
    for name, text in sources.items():
        if len(text.splitlines()) > MOST_LINES:
            yield f"{name} has {len(text.splitlines())} lines: split it, one noun a file"


def test_files_are_short() -> None:
    assert list(long_files(SOURCES)) == []
    assert len(list(long_files({"a.py": "x = 1\n" * (MOST_LINES + 1), "b.py": "x = 1\n" * MOST_LINES}))) == 1


class Source(NamedTuple):
    """What the rules ask of a source: (name, lines of code, arguments but `self` and `cls`) of its functions, every
    module or name in a module that it imports, inside functions too, and its dataclasses."""

    functions: tuple[tuple[str, int, int], ...]
    imported: tuple[str, ...]
    dataclasses: tuple[ast.ClassDef, ...]


@cache
def read(text: str) -> Source:
    """A source, parsed once for all rules: that takes far longer than to judge it."""
    nodes = list(ast.walk(ast.parse(text)))
    return Source(
        tuple(measured(node) for node in nodes if isinstance(node, Function)),
        tuple(name for node in nodes for name in imported(node)),
        tuple(node for node in nodes if isinstance(node, ast.ClassDef) and is_dataclass(node)),
    )


def measured(node: Function) -> tuple[str, int, int]:
    """Name, lines but those of its docstring, and number of arguments but `self` and `cls`."""
    given, first = node.args, node.body[0]
    names = [each.arg for each in (*given.posonlyargs, *given.args, *given.kwonlyargs)]
    arguments = [name for name in names if name not in ("self", "cls")]
    lines = (node.end_lineno or node.lineno) - node.lineno + 1
    if ast.get_docstring(node) is not None:
        lines -= (first.end_lineno or first.lineno) - first.lineno + 1
    return node.name, lines, len(arguments)


def imported(node: ast.AST) -> Iterator[str]:
    """The modules, and names in modules, that a statement imports, or names as entry points do, "module:NAME"."""
    if isinstance(node, ast.ImportFrom) and node.module:
        yield node.module
        yield from (f"{node.module}.{alias.name}" for alias in node.names)
    elif isinstance(node, ast.Import):
        yield from (alias.name for alias in node.names)
    elif isinstance(node, ast.Constant) and isinstance(node.value, str) and ENTRY.fullmatch(node.value):
        yield node.value.partition(":")[0]


def is_dataclass(node: ast.ClassDef) -> bool:
    """Whether a class is decorated as one."""
    return any(part.startswith(("dataclass", "frozen_arrays")) for part in decorators(node))


def large_functions(sources: Mapping[str, str]) -> Iterator[str]:
    """Functions with more lines or arguments than they may have; kernels may have more arguments."""
    for name, text in sources.items():
        arguments_allowed = KERNEL_ARGUMENTS if "/kernels/" in name else MOST_ARGUMENTS
        for function, lines, arguments in read(text).functions:
            if lines > MOST_FUNCTION_LINES:
                yield f"{name}: {function} has {lines} lines"
            if arguments > arguments_allowed:
                yield f"{name}: {function} has {arguments} arguments"


def test_functions_are_short_and_take_few_arguments() -> None:
    assert set(large_functions(SOURCES)) == KNOWN


def test_kernels_may_have_no_more_arguments_than_one_has() -> None:
    kernels = [found for name, text in SOURCES.items() if "/kernels/" in name for found in read(text).functions]
    assert max(arguments for _, _, arguments in kernels) == KERNEL_ARGUMENTS


@pytest.mark.parametrize(
    ("name", "source", "found"),
    [
        ("synth/a.py", "def f(a, b, c, d, e, f, g, *, h, i): ...", 1),
        ("synth/a.py", "class A:\n    def f(self, a, b, c, d, e, f, g, h): ...", 0),
        ("synth/a.py", "class A:\n    def f(self, a, b, c, d, e, f, g, h, i): ...", 1),
        ("synth/kernels/a.py", "def f(a, b, c, d, e, f, g, h, i): ...", 0),
        ("synth/kernels/a.py", f"def f({', '.join(f'a{i}' for i in range(KERNEL_ARGUMENTS + 1))}): ...", 1),
        ("synth/a.py", "def f():\n" + "    x = 1\n" * MOST_FUNCTION_LINES, 1),
        ("synth/a.py", "def f():\n" + "    x = 1\n" * (MOST_FUNCTION_LINES - 1), 0),
    ],
)
def test_a_large_function_is_found(name: str, source: str, found: int) -> None:
    assert len(list(large_functions({name: source}))) == found


def module_of(name: str) -> str:
    """The dotted name of a source file."""
    return name.removesuffix(".py").replace("/", ".").removesuffix(".__init__")


def reached(sources: Mapping[str, str], roots: set[str]) -> set[str]:
    """The modules that importing `roots` and running all their functions would import."""
    modules = {module_of(name): text for name, text in sources.items()}
    waiting, seen = sorted(roots), set[str]()
    while waiting:
        module = waiting.pop()
        if module in seen or module not in modules:
            continue
        seen.add(module)
        waiting += [module.rpartition(".")[0], *read(modules[module]).imported]
    return seen


def circles(sources: Mapping[str, str]) -> list[list[str]]:
    """Groups of modules that import each other, be it inside functions or for types alone."""
    modules = {module_of(name): set(read(text).imported) for name, text in sources.items()}
    graph = {module: known & modules.keys() - {module} for module, known in modules.items()}
    while leaves := [module for module, known in graph.items() if not known]:
        for module in leaves:
            del graph[module]
        graph = {module: known - set(leaves) for module, known in graph.items()}
    return [[module, *sorted(known)] for module, known in sorted(graph.items())]


def test_no_two_modules_import_each_other() -> None:
    packages = {name for name in SOURCES if name.endswith("__init__.py")}
    plain = {name: text for name, text in SOURCES.items() if name not in packages}
    assert circles(plain) == []
    planted = {
        "synth/a.py": "def f():\n    import synth.b",
        "synth/b.py": "from synth import c",
        "synth/c.py": "import synth.a",
    }
    assert [group[0] for group in circles(planted)] == ["synth.a", "synth.b", "synth.c"]


def unreached(sources: Mapping[str, str]) -> set[str]:
    """Modules outside the studies that no command, no front door, and for physics no study, has a use for."""
    modules = {module_of(name) for name in sources}
    studies = {module for module in modules if module.startswith("scripts")}
    used = reached(sources, {"synth.cli.commands", *PACKAGES}) | {
        module for module in reached(sources, studies) if module.startswith("plant_models")
    }
    return modules - studies - used


def with_stubs(sources: Mapping[str, str], stubs: Mapping[str, str]) -> dict[str, str]:
    """Sources, each package with the imports that its stub declares."""
    return {name: f"{text}\n{stubs.get(f'{name}i', '')}" for name, text in sources.items()}


def test_a_command_or_the_front_door_reaches_every_module() -> None:
    assert unreached(with_stubs(SOURCES, DECLARED)) == KNOWN_UNREACHED
    assert "synth.api.pictures" in unreached(SOURCES)


def test_a_module_that_nobody_needs_is_found() -> None:
    planted = {
        **with_stubs(SOURCES, DECLARED),
        "synth/retarder/intruder.py": "from synth.retarder import tune",
        "scripts/studies/intruder.py": "from synth.retarder import intruder\nfrom plant_models import intruder",
        "plant_models/intruder.py": "",
        "tuning_tables/intruder.py": "",
    }
    assert unreached(planted) - KNOWN_UNREACHED == {"synth.retarder.intruder", "tuning_tables.intruder"}
