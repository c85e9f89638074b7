"""Exported C of which one file is changed, again and again: all its other files are compiled once for all changes."""

from __future__ import annotations

import subprocess
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from scripts.studies.in_the_loop.controller_process import compile_with

COMPILE = ("gcc", "-std=c99", "-w", "-O0")
"""The quickest way: a fault in the text is one at every level."""

SELF_TEST = ("sh", "-c", 'ulimit -t 2; exec "$0" self-test')
"""Takes milliseconds: one that hangs is ended after two seconds of the processor, and has found a fault, too."""

Said = subprocess.CompletedProcess[str]


@dataclass(frozen=True)
class ChangedExport:
    """An export with self-tests of one or more sizes: `content` of the file that is changed, the same in each of them.

    `others`: for each self-test the objects of all other files, the program around them included. `folder` holds the
    headers.
    """

    folder: Path
    name: str
    content: str
    others: tuple[tuple[str, ...], ...]

    def self_tests(self, before: str, after: str, work: Path) -> list[Said]:
        """What each self-test says where `before`, which must be there, is `after` in its first place."""
        assert before in self.content
        return self.self_tests_of(self.content.replace(before, after, 1), work)

    def self_tests_of(self, content: str, work: Path) -> list[Said]:
        """What each self-test says of another content, compiled once for all in `work`, a folder of the caller."""
        source, changed, program = work / self.name, str(work / "changed.o"), str(work / "changed")
        source.write_text(content, "ascii", newline="")
        # The headers are not beside it, but in the folder of the others.
        compile_with([*COMPILE, f"-I{self.folder}", "-c", str(source), "-o", changed])
        said = []
        for others in self.others:
            compile_with(["gcc", changed, *others, "-o", program])
            said.append(subprocess.run([*SELF_TEST, program], capture_output=True, text=True, check=False))
        return said


def changed_export(exports: Sequence[Mapping[str, bytes]], name: str, folder: Path) -> ChangedExport:
    """The `exports`, written below `folder`, which exists, and compiled there, all but the file called `name`."""
    (content,) = {files[name] for files in exports}
    others = []
    for number, files in enumerate(exports):
        place = folder / str(number)
        place.mkdir()
        for file, text in files.items():
            if file != name:
                (place / file).write_bytes(text)
        sources = [place / file for file in files if file.endswith(".c") and file != name]
        for source in sources:
            compile_with([*COMPILE, "-c", str(source), "-o", f"{source}.o"])
        others.append(tuple(f"{source}.o" for source in sources))
    return ChangedExport(folder / "0", name, content.decode("ascii"), tuple(others))
