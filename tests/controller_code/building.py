"""C made and run: programs that answer questions, exports with one file changed, planted faults, ways of
compiling.
"""

from __future__ import annotations

import re
import subprocess
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Final

from scripts.studies.in_the_loop.controller_process import BUILDS, Build, compile_with
from tests.effort import sized


def written(files: Mapping[str, bytes], folder: Path) -> list[str]:
    """The sources among the files, which are in `folder` then."""
    for name, content in files.items():
        (folder / name).write_bytes(content)
    return [str(folder / name) for name in files if name.endswith(".c")]


def built(files: Mapping[str, bytes], program: str, folder: Path, build: Build) -> list[str]:
    """The command that runs `program`, a text in C, with the exported files in it."""
    main = folder / "main.c"
    main.write_text(program)
    sources = written(files, folder)
    for source in sources:
        compile_with([build.compiler, *build.contract, *build.flags, "-c", source, "-o", f"{source}.o"])
    objects = [f"{source}.o" for source in sources]
    compile_with([build.compiler, *build.flags, *build.link, str(main), *objects, "-o", str(folder / "program")])
    return [*build.emulator, str(folder / "program")]


def told(command: Sequence[str], *arguments: str, given: bytes = b"") -> bytes:
    """What a program answers."""
    return subprocess.run([*command, *arguments], input=given, capture_output=True, timeout=300, check=True).stdout


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


SWAPPED: Final = {
    "+": "-", "-": "+", "*": "/", "/": "*", "<": "<=", ">": ">=", "<=": "<", ">=": ">", "&&": "||", "||": "&&",
    "==": "!=", "!=": "==",
}  # fmt: skip
OPERATOR: Final = re.compile(r"(?<= )(?:[-+*/<>]|[<>=!]=|&&|\|\|)(?= |\n)")
CONSTANT: Final = re.compile(r"^#define (\w+) (-?0x\S+f)", re.M)
ASSIGNED: Final = re.compile(r"^ +(?:\*?\w+|[\w>\-\[\].]+) = [^;]*;$", re.M)
COARSE: Final = ("GATE_SQUARED", "FEW_READINGS")
"""Constants of which a hundredth is lost when it comes to readings."""

COMMENT: Final = re.compile(r"/\*.*?\*/", re.S)


def planted_faults(code: str) -> Iterator[tuple[str, str]]:
    """(what was changed, the code with it) for every fault, in the order of the text."""
    hidden = {at for match in COMMENT.finditer(code) for at in range(*match.span())}
    for match in OPERATOR.finditer(code):
        if match.start() not in hidden:
            yield changed(code, match, SWAPPED[match[0]])
    for match in CONSTANT.finditer(code):
        yield changed(code, match, f"#define {match[1]} ({match[2]} * {1.5 if match[1] in COARSE else 1.01}f)")
    for match in ASSIGNED.finditer(code):
        if match.start() not in hidden:
            yield changed(code, match, "(void)0;")


def changed(code: str, match: re.Match[str], to: str) -> tuple[str, str]:
    """What is changed, as its line and the change, and the code."""
    line = code[code.rfind("\n", 0, match.start()) + 1 : code.index("\n", match.start())].strip()
    shown = "left out" if to == "(void)0;" else f"{match[0]} -> {to}"
    return f"{line}: {shown}", code[: match.start()] + to + code[match.end() :]


USUAL_AND_FUSED: Final = ("gcc -O2", "clang -O3 -mfma -ffp-contract=fast without -std=c99")
UNLIKE: Final = (
    *USUAL_AND_FUSED,
    "gcc -O2 -mfpmath=387 without -std=c99",
    "arm-linux-gnueabihf-gcc -O2 -mthumb",
    "powerpc-linux-gnu-gcc -O2",
)
"""Registers of 80 bits, other processors, the highest byte first; and the two above."""


def ways_named(*names: str) -> tuple[Build, ...]:
    """Ways of compiling by what they are called."""
    return tuple(build for build in BUILDS if str(build) in names)


SANITIZED: Final = tuple(
    build for build in BUILDS if build.compiler == "gcc" and any("sanitize" in flag for flag in build.flags)
)
WAYS: Final = sized((*ways_named(*UNLIKE), *SANITIZED), BUILDS)
"""What each kind of tables is compiled in."""
FEW_WAYS: Final = ways_named(*USUAL_AND_FUSED)
"""What a book is compiled in whose code is a part of another one's."""
