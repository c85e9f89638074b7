"""A program that reads questions and writes answers, built of exported files, and what it tells."""

from __future__ import annotations

import subprocess
from collections.abc import Mapping, Sequence
from pathlib import Path

from scripts.studies.in_the_loop.builds import Build
from scripts.studies.in_the_loop.controller_process import compile_with


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
