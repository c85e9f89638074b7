"""Two small books of tables, each made twice: by the kernels as they are, and by their plain text."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Mapping
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from importlib.resources import files
from pathlib import Path
from typing import Any, Final

from synth.cli.qualification.check import Ran, program
from synth.kernels.plain import VARIABLE

ESTIMATED, MEASURED = "estimated", "measured"
KINDS: Final = (ESTIMATED, MEASURED)
"""With and without an estimator: without one the prediction is exact, and shares nothing with the simulation."""

PLAIN: Final = "plain"
LEFT_OUT: Final = ("created", "crc32", "exported_by", "generator")
NO_PICTURES: Final = "[output]\nplots = false\nreport = false\n"


def problem(kind: str) -> str:
    """The configuration of the book `kind`: one class of cuts, one target, a coarse grid."""
    return (files("synth.cli.qualification") / f"{kind}.toml").read_text(encoding="utf-8")


@dataclass(frozen=True)
class Tuned:
    """What a tune left in `folder`; `content` is every file of it by name, none where it failed."""

    kind: str
    folder: Path
    ran: Ran
    content: Mapping[str, bytes]

    @property
    def tables(self) -> Mapping[str, bytes]:
        """The files of the tables by name."""
        return {name: content for name, content in self.content.items() if name.startswith("tables/")}

    @property
    def summary(self) -> Mapping[str, Any]:
        """What the tune says of itself."""
        return dict(json.loads(self.content["summary.json"]))

    @property
    def document(self) -> Mapping[str, Any]:
        """The first table."""
        return dict(json.loads(next(iter(self.tables.values()))))

    @property
    def sha256(self) -> str:
        """Of the numbers of the tables, whatever version of the program wrote them."""
        digest = hashlib.sha256()
        for name, content in sorted(self.tables.items()):
            digest.update(name.encode() + numbers_of(content))
        return digest.hexdigest()


def numbers_of(table: bytes) -> bytes:
    """A table less when and by which version it was made, and less the checksum, which is over these too."""
    document = json.loads(table)
    return json.dumps({key: document[key] for key in sorted(document) if key not in LEFT_OUT}).encode()


def tuned(folder: Path, kind: str, plain: bool) -> Tuned:
    """Tune the book `kind` below `folder`."""
    name = f"{kind}-{PLAIN}" if plain else kind
    config = folder / f"{name}.toml"
    config.write_text(NO_PICTURES + problem(kind), encoding="utf-8")
    ran = program(f"tune {config.name} -o {name} --workers 1", folder, {VARIABLE: "1" if plain else "0"})
    return Tuned(kind, folder / name, ran, contents(folder / name) if ran.code == 0 else {})


def contents(folder: Path) -> dict[str, bytes]:
    """Every file below `folder` by its name relative to it, but for those whose names begin with a dot."""
    found = (path for path in sorted(folder.rglob("*")) if path.is_file() and not path.name.startswith("."))
    return {path.relative_to(folder).as_posix(): path.read_bytes() for path in found}


def tuned_twice(folder: Path) -> tuple[tuple[Tuned, ...], tuple[Tuned, ...]]:
    """(the books, the same by plain text), in two processes side by side."""

    def books(plain: bool) -> tuple[Tuned, ...]:
        return tuple(tuned(folder, kind, plain) for kind in KINDS)

    with ThreadPoolExecutor(2) as pool:
        usual, plain = pool.map(books, (False, True))
    return usual, plain
