"""A unit of FMI as a file: documents, C and, where this machine has a C compiler, the library made of it."""

from __future__ import annotations

import hashlib
import io
import platform as machine
import shutil
import subprocess
import tempfile
import uuid
import zipfile
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from importlib.resources import files
from pathlib import Path
from typing import Final

from synth.frame.faults import InputError
from synth.retarder.fmi.description import FMI_3, Head, Interface
from synth.retarder.fmi.variables import TIME, Variable, variables_c, variables_h
from tuning_tables.export_names import exporter

COMPILERS: Final = ("cc", "gcc", "clang")
SWITCHES: Final = ("-std=c99", "-O2", "-fPIC", "-shared", "-fvisibility=hidden", "-ffp-contract=off")
"""No contraction: a fused multiply-add rounds otherwise, and a pass would differ from that of the simulator."""

PLATFORMS: Final = {("Linux", "x86_64"): "x86_64-linux", ("Linux", "aarch64"): "aarch64-linux"}
"""Platforms by what Python calls system and processor, as FMI 3.0 calls them."""

LONGEST_S: Final = 120.0


@dataclass(frozen=True)
class CompiledLibrary:
    """A shared library, ready to be loaded."""

    name: str
    content: bytes


def compiler() -> str | None:
    """The path of the first C compiler that there is; None where there is none."""
    return next(filter(None, map(shutil.which, COMPILERS)), None)


def platform() -> str | None:
    """That of libraries made here; None where no library is made."""
    return PLATFORMS.get((machine.system(), machine.machine()))


def compiled(sources: Mapping[str, str], identifier: str) -> CompiledLibrary | None:
    """The library of `sources`, files of C by name; None where compiler or platform are not there.

    `InputError` with the first line of what the compiler says where it refuses them.
    """
    path = compiler()
    if path is None or platform() is None:
        return None
    name = f"{identifier}.so"
    with tempfile.TemporaryDirectory(prefix="retarder-synth-") as folder:
        for file, text in sources.items():
            (Path(folder) / file).write_text(text, encoding="ascii")
        # Named without a folder, so that no path gets into the library.
        order = [path, *SWITCHES, "-o", name, *sorted(file for file in sources if file.endswith(".c"))]
        order += ["-lm", "-Wl,--build-id=none", "-Wl,-s"]
        try:
            done = subprocess.run(order, cwd=folder, capture_output=True, text=True, timeout=LONGEST_S, check=False)
        except (OSError, subprocess.TimeoutExpired) as fault:
            raise InputError(f"{path}: the C compiler does not run ({fault}); mend it or take it off PATH") from None
        if done.returncode != 0:
            said = next((line for line in done.stderr.splitlines() if line.strip()), "nothing")
            raise InputError(f"{path}: the C compiler does not take the unit: {said}; mend it or take it off PATH")
        return CompiledLibrary(name, (Path(folder) / name).read_bytes())


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
