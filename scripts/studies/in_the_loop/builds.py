"""The ways of compiling that the exported controller is proved with: compilers, levels, processors, sanitizers."""

from __future__ import annotations

import shutil
from dataclasses import dataclass
from pathlib import Path
from typing import Literal

from scripts.studies.in_the_loop.controller_process import CONTRACT, Controller, build_controller
from tuning_tables.table_book import TableBook

FREELY = ("-Wall", "-Wextra", "-Werror")
"""Without -std=c99, with which GCC never fuses a multiplication and an addition."""


@dataclass(frozen=True)
class Build:
    """One way of compiling, `link` for the program around; `emulator` runs it where the processor is another."""

    compiler: str
    flags: tuple[str, ...]
    contract: tuple[str, ...] = CONTRACT
    link: tuple[str, ...] = ()
    emulator: tuple[str, ...] = ()
    order: Literal["<", ">"] = "<"

    def __str__(self) -> str:
        shown = " ".join((self.compiler, *self.flags))
        return shown if self.contract is CONTRACT else f"{shown} without -std=c99"

    def missing(self) -> tuple[str, ...]:
        """The programs that this machine lacks for it."""
        return tuple(name for name in (self.compiler, *self.emulator) if shutil.which(name) is None)

    def controller(self, book: TableBook, directory: Path) -> Controller:
        """The controller of `book`, built in `directory`; raises as `build_controller`."""
        return build_controller(
            book, directory, self.compiler, self.flags, self.contract, self.link, self.emulator, self.order
        )


SANITIZED = ("-g", "-O1", "-fsanitize=address,undefined", "-fno-sanitize-recover=all", "-fno-omit-frame-pointer")
STATIC = ("-static",)

BUILDS: tuple[Build, ...] = (
    *(Build(compiler, (f"-O{level}",)) for compiler in ("gcc", "clang") for level in range(4)),
    *(Build(compiler, ("-O3", "-mfma", "-ffp-contract=fast"), FREELY) for compiler in ("gcc", "clang")),
    Build("gcc", ("-O2", "-mfpmath=387"), FREELY),  # 80-bit registers
    *(Build(compiler, SANITIZED) for compiler in ("gcc", "clang")),
    *(
        Build("arm-linux-gnueabihf-gcc", flags, CONTRACT, STATIC, ("qemu-arm",))
        for flags in (("-O0",), ("-O2", "-mthumb"), ("-O3", "-marm", "-mfpu=vfpv4", "-ffp-contract=fast"))
    ),
    Build("powerpc-linux-gnu-gcc", ("-O2",), CONTRACT, STATIC, ("qemu-ppc",), ">"),  # highest byte first
)
"""On an x86-64 machine with the programs of scripts/setup_toolchain."""
