"""Exported C of which one file is changed, again and again: all its other files are compiled once for all changes."""

from __future__ import annotations

import subprocess
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

from scripts.studies.in_the_loop.controller_process import compile_with

COMPILE = ("gcc", "-std=c99", "-w", "-O1")


@dataclass(frozen=True)
class ChangedExport:
    """An export and the program around it in `folder`: `content` of the file that is changed, objects of the others."""

    folder: Path
    name: str
    content: str
    others: tuple[str, ...]

    def self_test(self, before: str, after: str, work: Path) -> subprocess.CompletedProcess[str]:
        """What the self-test says where `before`, which must be there, is `after` in its first place."""
        assert before in self.content
        return self.self_test_of(self.content.replace(before, after, 1), work)

    def self_test_of(self, content: str, work: Path) -> subprocess.CompletedProcess[str]:
        """What the self-test says with another content of the file, compiled in `work`, a folder of the caller."""
        source, program = work / self.name, str(work / "changed")
        source.write_text(content, "ascii", newline="")
        # The headers are not beside it, but in the folder of the others.
        compile_with([*COMPILE, f"-I{self.folder}", str(source), *self.others, "-o", program])
        return subprocess.run([program, "self-test"], capture_output=True, text=True, timeout=60, check=False)


def changed_export(files: Mapping[str, bytes], name: str, folder: Path) -> ChangedExport:
    """The export `files`, written to `folder`, which exists, and compiled there, all but the one called `name`."""
    others = []
    for file, content in files.items():
        if file != name:
            (folder / file).write_bytes(content)
            if file.endswith(".c"):
                others.append(str(folder / f"{file}.o"))
                compile_with([*COMPILE, "-c", str(folder / file), "-o", others[-1]])
    return ChangedExport(folder, name, files[name].decode("ascii"), tuple(others))
