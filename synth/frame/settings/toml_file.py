"""A TOML file as nested tables: read in bounded time and memory, of numbers and depths that a program can hold."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final

from synth.frame.faults import MACHINE_FAULTS, InputError
from synth.frame.settings.toml_syntax import syntax_faults
from tuning_tables import DamagedTable
from tuning_tables.errors import excerpt
from tuning_tables.whole_file import read_regular_file

Tree = dict[str, Any]

LARGEST_FILE_BYTES: Final = 4 * 2**20
DEEPEST: Final = 20
"""Tables and lists within one another; a configuration needs five."""

LARGEST_WHOLE_NUMBER: Final = 2**63 - 1
"""Of TOML, which has no more than 64 bits for a whole number."""


def read_text(path: Path, template: str = "init") -> str:
    """The text of the regular file at `path`; `InputError` if there is none, `OSError` for a fault of the machine.

    `template`: the command that prints such a file.
    """
    try:
        return read_content(path, template).decode("utf-8-sig")
    except UnicodeDecodeError as error:
        raise InputError(f"{path}: byte {error.start} is not UTF-8 text; save the file as UTF-8") from None


def read_content(path: Path, template: str = "init") -> bytes:
    """The same as bytes, whatever they are."""
    try:
        return read_regular_file(path, LARGEST_FILE_BYTES)
    except FileNotFoundError:
        raise InputError(
            f"{path}: there is no such file; write one with 'retarder-synth {template} -o {path.name}'"
        ) from None
    except IsADirectoryError:
        raise InputError(f"{path}: this is a directory; give the path of a TOML configuration file") from None
    except DamagedTable:
        raise InputError(
            f"{path}: it has more than {LARGEST_FILE_BYTES} bytes, which no configuration needs; give a TOML file"
        ) from None
    except OSError as error:
        if error.errno in MACHINE_FAULTS:
            raise
        raise InputError(f"{path}: cannot be read ({error.strerror}); check the path and its permissions") from None


def toml_tree(text: str, file: str) -> Tree:
    """The tables in `text`; `file` is what messages call it. `InputError` for what is no TOML or beyond its limits."""
    read = read_toml(text, file)
    if read.faults or read.tree is None:
        raise InputError(*read.faults)
    return read.tree


@dataclass(frozen=True)
class ReadToml:
    """A text with a sentence for each of its `faults`; `text` is as it was meant, with its `tree`, None where nobody
    knows that."""

    text: str
    tree: Tree | None
    faults: tuple[str, ...]


def read_toml(text: str, file: str) -> ReadToml:
    """The tables in `text`, and what is no TOML in it; `file` is what messages call it. `InputError` for what is beyond
    the limits."""
    try:
        found = syntax_faults(text, file)
        repr(found.tree)  # a hexadecimal number is read in any length, but not told
    except RecursionError:
        raise InputError(f"{file}: its lists or tables are nested too deeply; at most {DEEPEST} are allowed") from None
    except ValueError:  # Python turns no longer text into a whole number
        raise InputError(f"{file}: a number in it has thousands of digits; whole numbers have at most 19") from None
    if found.tree is not None:
        require_bounded(found.tree, file)
    return ReadToml(text if found.mended is None else found.mended, found.tree, found.sentences)


def require_bounded(tree: Tree, file: str) -> None:
    """`InputError` naming the key of whatever is nested too deeply, or is a whole number that TOML does not have."""
    waiting: list[tuple[str, object, int]] = [("", tree, 0)]
    while waiting:  # no recursion: the tree may be deeper than Python's stack
        key, value, depth = waiting.pop()
        if depth > DEEPEST:
            raise InputError(f"{file}: {excerpt(key)} is nested too deeply; at most {DEEPEST} levels are allowed")
        if isinstance(value, dict):
            waiting += [(f"{key}.{name}".lstrip("."), below, depth + 1) for name, below in value.items()]
        elif isinstance(value, list):
            waiting += [(f"{key}[{place}]", below, depth + 1) for place, below in enumerate(value)]
        elif isinstance(value, int) and not -LARGEST_WHOLE_NUMBER - 1 <= value <= LARGEST_WHOLE_NUMBER:
            raise InputError(
                f"{file}: {excerpt(key)} is {excerpt(str(value), 40)}; a whole number of TOML must be from -2^63 to "
                "2^63 - 1"
            )
