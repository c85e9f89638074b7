"""A package that shows the names its stub declares, and imports what they stand for when they are first used.

The stub, `__init__.pyi` beside `__init__.py`, is the only list: editors and type checkers read it as it is.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from importlib import import_module


def declared_names(package: str, file: str) -> tuple[Callable[[str], object], Callable[[], list[str]]]:
    """`__getattr__` and `__dir__` of the `package` whose `__init__.py` is `file`; nothing is read before they are used.

    The stub says `from module import name as name` of each name. `__all__` is the sorted list of them.
    """

    @cache
    def homes() -> dict[str, str]:
        import ast  # start-up: this and pathlib would be most of the time of an import

        with open(f"{file}i", encoding="utf-8") as stub:
            imports = [node for node in ast.parse(stub.read()).body if isinstance(node, ast.ImportFrom)]
        return {alias.name: node.module or "" for node in imports for alias in node.names}

    def names() -> list[str]:
        return sorted(homes())

    @cache
    def value(name: str) -> object:
        if name == "__all__":
            return names()
        if name not in homes():
            raise AttributeError(f"module {package!r} has no attribute {name!r}")
        return getattr(import_module(homes()[name]), name)

    return value, names
