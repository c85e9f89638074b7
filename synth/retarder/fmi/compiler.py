"""The C compiler of this machine, where there is one: it makes the library of a unit."""

from __future__ import annotations

import platform as machine
import shutil
import subprocess
import tempfile
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Final

from synth.frame.input_error import InputError

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
