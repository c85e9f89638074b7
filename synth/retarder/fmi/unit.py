"""A unit of FMI as a file: documents, C and, where a C compiler is at hand, the library made of it."""

from __future__ import annotations

import hashlib
import io
import uuid
import zipfile
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from importlib.resources import files
from typing import Final

from synth.retarder.fmi.compiler import compiled, platform
from synth.retarder.fmi.description import Head
from synth.retarder.fmi.interfaces import FMI_3, Interface
from synth.retarder.fmi.variables import TIME, Variable, variables_c, variables_h
from tuning_tables.exporter import exporter

ZIP_DATE: Final = (1980, 1, 1, 0, 0, 0)
"""The first that a ZIP archive can tell: no day of the export is in it."""


def c_part(name: str) -> str:
    """The text of a file of C that stands as it is."""
    return (files("synth.retarder.fmi") / "c" / name).read_text("ascii")


@dataclass(frozen=True)
class Unit:
    """A unit: what it says of itself, its variables without time, and its own files of C by name.

    `period_s`: length of a step, 0 where a step may have any.
    """

    identifier: str
    name: str
    meaning: str
    own: Sequence[Variable]
    c: Mapping[str, str]
    period_s: float = 0.0

    @property
    def variables(self) -> tuple[Variable, ...]:
        """All of them."""
        return (TIME, *self.own)

    def token(self, interface: Interface) -> str:
        """What tells this unit from all others: of its variables and its C."""
        told = hashlib.sha256(repr((self.variables, sorted(self.c.items()), self.period_s)).encode())
        for name in interface.c:
            told.update(c_part(name).encode())
        return f"{{{uuid.UUID(bytes=told.digest()[:16])}}}"

    def sources(self, interface: Interface = FMI_3) -> dict[str, str]:
        """All files of C, by name."""
        listed = interface.listed(self.variables)
        return {
            **{name: c_part(name) for name in interface.c},
            "variables.h": variables_h(self.variables, len(listed), self.period_s, self.token(interface)),
            "variables.c": variables_c(self.variables, listed),
            **self.c,
        }

    def content(self, sources: Mapping[str, str], interface: Interface) -> dict[str, bytes]:
        """The files of the archive, by path; the library is there where a C compiler has made it."""
        head = Head(self.identifier, self.name, self.meaning, exporter(), self.token(interface), self.period_s)
        compilable = sorted(name for name in sources if name.endswith(".c"))
        folder = interface.folders.get(platform() or "")
        library = compiled(sources, self.identifier) if folder else None
        binaries = {} if library is None else {f"binaries/{folder}/{library.name}": library.content}
        return {
            **interface.documents(head, interface.listed(self.variables), compilable),
            **{f"sources/{name}": text.encode("ascii") for name, text in sorted(sources.items())},
            **binaries,
        }

    def archive(self, interface: Interface = FMI_3) -> bytes:
        """The file: the same bytes for the same unit, with the same compiler and zlib."""
        room = io.BytesIO()
        with zipfile.ZipFile(room, "w") as archive:
            for name, content in self.content(self.sources(interface), interface).items():
                entry = zipfile.ZipInfo(name, ZIP_DATE)
                entry.compress_type, entry.external_attr = zipfile.ZIP_DEFLATED, 0o644 << 16
                archive.writestr(entry, content)
        return room.getvalue()
