"""What the packages show: the names that they declare and no others, each with a docstring whose example runs."""

from __future__ import annotations

import ast
import dataclasses
import doctest
import inspect
import re
from collections.abc import Iterator
from functools import cache
from importlib import import_module
from pathlib import Path
from types import FunctionType, ModuleType
from typing import Any

import pytest

ROOT = Path(__file__).parents[2]
LAZY = ("synth", "synth.hump.control")
DOORS = ("synth", "plant_models", "tuning_tables", "tuning_tables.aim", "tuning_tables.pass_log")
"""Packages whose names have a reference page."""


def door(name: str) -> ModuleType:
    """The package of that name; what it has is not known to mypy."""
    return import_module(name)


@pytest.mark.parametrize("name", [*DOORS, "synth.hump.control"])
def test_a_package_shows_what_it_declares_and_nothing_else(name: str) -> None:
    package = door(name)
    assert dir(package) == sorted(package.__all__)
    homes = {getattr(getattr(package, each), "__module__", name).partition(".")[0] for each in dir(package)}
    assert homes == {name.partition(".")[0]}
    with pytest.raises(AttributeError, match="has no attribute 'nothing'"):
        package.nothing  # noqa: B018


@pytest.mark.parametrize("name", LAZY)
def test_the_stub_is_the_list(name: str) -> None:
    """Every name in it is re-exported as type checkers want it: under its own name, from where it is defined."""
    stub = ast.parse((ROOT / name.replace(".", "/") / "__init__.pyi").read_text(encoding="utf-8"))
    assert all(isinstance(node, ast.ImportFrom) for node in stub.body)
    aliases = [(node.module, each) for node in stub.body if isinstance(node, ast.ImportFrom) for each in node.names]
    assert sorted(each.name for _, each in aliases) == dir(door(name))
    assert all(each.asname == each.name for _, each in aliases)
    inside = {path.stem for path in (ROOT / name.replace(".", "/")).iterdir()}
    assert inside.isdisjoint(dir(door(name))), "a module that is imported would take the place of the name"
    assert all(getattr(import_module(str(module)), each.name) is not None for module, each in aliases)


def public(name: str) -> Iterator[tuple[str, Any]]:
    """(name, value) of what a package shows, of which a docstring is its own."""
    for each in dir(door(name)):
        value = getattr(door(name), each)
        if isinstance(value, type | FunctionType):
            yield f"{name}.{each}", value


def members(value: type) -> Iterator[tuple[str, Any]]:
    """(name, function) of the public methods and properties that a class of this project defines."""
    for name, member in vars(value).items():
        function = getattr(member, "fget", None) or getattr(member, "func", None) or getattr(member, "__func__", member)
        if not name.startswith("_") and isinstance(function, FunctionType):
            yield name, function


EVERYTHING = [each for name in DOORS for each in public(name)]
FUNCTIONS = [(name, value) for name, value in EVERYTHING if isinstance(value, FunctionType)]
SLOW = {"synth.figures", "synth.identify"}
"""Examples that take seconds."""

CLASSES = [(name, value) for name, value in EVERYTHING if isinstance(value, type)]

EXPLAINED = {value.__name__ for _, value in CLASSES}
"""Classes that say themselves what they are, wherever they are a member."""


def listed(told: str) -> set[str]:
    """The names in the sections of parameters and attributes of a docstring."""
    sections = [each for each in told.split("\n\n") if each.startswith(("Parameters\n---", "Attributes\n---"))]
    lines = [line for section in sections for line in section.splitlines() if line[:1].strip()]
    return {each.strip().lstrip("*") for line in lines for each in line.split(",")}


@pytest.mark.parametrize(("name", "function"), FUNCTIONS, ids=[name for name, _ in FUNCTIONS])
def test_a_function_says_what_it_takes_and_gives(name: str, function: FunctionType) -> None:
    told, parameters = inspect.getdoc(function) or "", set(inspect.signature(function).parameters)
    assert parameters <= listed(told), f"{name} does not say what {parameters - listed(told)} are"
    if inspect.signature(function).return_annotation not in ("None", None):
        assert "\nReturns\n---" in told
    assert "\nExamples\n---" in told


@pytest.mark.parametrize(("name", "value"), CLASSES, ids=[name for name, _ in CLASSES])
def test_a_class_and_its_members_are_explained(name: str, value: type) -> None:
    own = vars(value)["__doc__"] or f"{value.__name__}("
    assert not own.startswith(f"{value.__name__}("), f"{name} has no docstring"
    if not issubclass(value, Exception) and dataclasses.is_dataclass(value):
        assert "Examples\n" in own, f"{name} has no example"
        hints = value.__annotations__.items()
        declared = {each for each, hint in hints if hint.startswith("Annotated[") or hint.split(" |")[0] in EXPLAINED}
        members_of = {each.name for each in dataclasses.fields(value) if not each.name.startswith("_")}
        told = listed(inspect.getdoc(value) or "") | declared
        assert {each for each in members_of - told if f"`{each}`" not in own} == set()
    for member, function in members(value):
        assert function.__doc__, f"{name}.{member} has no docstring"


OTHER = re.compile(r"from the example of `(\w+)`")
"""How an example says that it goes on from another one."""


@cache
def namespace(package: str, name: str) -> dict[str, Any]:
    """The names that the example of `name` leaves behind."""
    globs: dict[str, Any] = {}
    source = inspect.getdoc(getattr(door(package), name)) or ""
    exec("".join(each.source for each in doctest.DocTestParser().get_examples(source)), globs)
    return globs


def examples() -> dict[str, doctest.DocTest]:
    """The examples of everything public, by where they stand; a class comes with its members."""
    finder, found = doctest.DocTestFinder(exclude_empty=True), {}
    for name, value in EVERYTHING:
        module = import_module(value.__module__)
        for each in finder.find(value, name, module=module, globs={}):
            if each.examples:
                found[each.name] = each
    return found


EXAMPLES = examples()


@pytest.mark.parametrize("name", [pytest.param(name, marks=[pytest.mark.long] * (name in SLOW)) for name in EXAMPLES])
def test_an_example_runs(name: str) -> None:
    example, told = EXAMPLES[name], list[str]()
    if other := OTHER.search(example.docstring or ""):
        package = next(each for each in sorted(DOORS, key=len, reverse=True) if name.startswith(f"{each}."))
        example.globs.update(namespace(package, other.group(1)))
    runner = doctest.DocTestRunner(optionflags=doctest.ELLIPSIS)
    assert runner.run(example, out=told.append).failed == 0, "".join(told)
