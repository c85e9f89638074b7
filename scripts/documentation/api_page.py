"""The public names of the packages as directives of Sphinx, which reads their docstrings."""

from __future__ import annotations

import inspect
from collections.abc import Iterator
from importlib import import_module

PACKAGES = ("synth", "tuning_tables", "plant_models")
"""Those that a program imports."""


def api_text(package: str) -> str:
    """What `package` shows, in the order of its `__all__`: classes with their members, functions, other values."""
    module = import_module(package)
    return "\n".join(directive_of(package, name, getattr(module, name)) for name in module.__all__)


def directive_of(package: str, name: str, value: object) -> str:
    """A name as MyST shows it."""
    return "\n".join((f"## {name}\n", "```{eval-rst}", *lines_of(package, name, value), "```\n"))


def lines_of(package: str, name: str, value: object) -> Iterator[str]:
    """The directive of one name."""
    if inspect.isclass(value):
        yield f".. autoclass:: {package}.{name}"
        yield "   :members:"
    elif callable(value):
        yield f".. autofunction:: {package}.{name}"
    else:
        yield f".. autodata:: {package}.{name}"
