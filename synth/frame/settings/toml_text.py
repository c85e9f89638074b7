"""A configuration written as TOML, so that the commands that take one can be given a condition of a sweep."""

from __future__ import annotations

import json
from collections.abc import Iterator
from typing import Any


def toml_text(tree: dict[str, Any]) -> str:
    """`tree` of tables, lists of tables, lists, strings, numbers and truth values; `tomllib` reads it back the same."""
    return "\n".join(table_lines(tree, "")) + "\n"


def table_lines(tree: dict[str, Any], prefix: str) -> Iterator[str]:
    """The lines of one table: plain keys first, for what follows a header belongs to it."""
    for key, value in tree.items():
        if not isinstance(value, dict) and not is_table_list(value):
            yield f"{key_text(key)} = {value_text(value)}"
    for key, value in tree.items():
        name = f"{prefix}{key_text(key)}"
        if isinstance(value, dict):
            yield f"\n[{name}]"
            yield from table_lines(value, f"{name}.")
        elif is_table_list(value):
            for item in value:
                yield f"\n[[{name}]]"
                yield from table_lines(item, f"{name}.")


def is_table_list(value: object) -> bool:
    """A list of tables, which has a header an item."""
    return isinstance(value, list) and bool(value) and all(isinstance(item, dict) for item in value)


def key_text(key: str) -> str:
    """A key, in quotes where it is no bare one."""
    bare = key and all(part.isascii() and (part.isalnum() or part in "_-") for part in key)
    return key if bare else value_text(key)


def value_text(value: Any) -> str:
    """A value within a line."""
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, str):
        return json.dumps(value, ensure_ascii=False).replace("\x7f", "\\u007f")
    if isinstance(value, list | tuple):
        return f"[{', '.join(value_text(item) for item in value)}]"
    if isinstance(value, dict):
        return f"{{{', '.join(f'{key_text(key)} = {value_text(item)}' for key, item in value.items())}}}"
    return repr(value)
