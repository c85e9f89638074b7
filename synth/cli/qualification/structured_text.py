"""The exported Structured Text under MATIEC, where it is found: translated to C, compiled, and its self-test run."""

from __future__ import annotations

import os
import shutil
from collections.abc import Iterator
from pathlib import Path
from typing import Final

from synth.cli.qualification.c_code import first_complaint
from synth.cli.qualification.check import Check, checked, not_checked, process, program
from synth.cli.qualification.tuned import Tuned

TRANSLATOR: Final = "iec2c"
LIBRARY: Final = "MATIEC_INCLUDE_PATH"
WHAT: Final = "Structured Text: MATIEC"
HOW: Final = "translated to C by iec2c, compiled, RETARDER_SELF_TEST called once a cycle until Done"
LIMIT: Final = "no message, then Failed = 0"
REMEDY: Final = (
    f"put {TRANSLATOR} and a C compiler on PATH and set {LIBRARY} to its folder lib, or run the self-test in your PLC"
)

CYCLES: Final = 10_000
"""Most calls of the self-test; each runs one of its blocks."""

CONFIGURATION: Final = """
PROGRAM TRY
VAR
    Test : RETARDER_SELF_TEST;
    Finished : BOOL;
    Faults : INT;
END_VAR
Test();
Finished := Test.Done;
Faults := Test.Failed;
END_PROGRAM

CONFIGURATION CONFIG0
    RESOURCE RES0 ON PLC
        TASK ONCE_A_CYCLE(INTERVAL := T#20ms, PRIORITY := 0);
        PROGRAM INST0 WITH ONCE_A_CYCLE : TRY;
    END_RESOURCE
END_CONFIGURATION
"""
MAIN: Final = f"""\
#include <stdio.h>
#include "iec_std_lib.h"
#include "POUS.h"

TIME __CURRENT_TIME;
BOOL __DEBUG;
extern TRY RES0__INST0;
void config_init__(void);
void config_run__(unsigned long tick);

int main(void)
{{
    unsigned long tick = 0;
    config_init__();
    while (!__GET_VAR(RES0__INST0.FINISHED,) && tick < {CYCLES}ul)
        config_run__(tick++);
    if (!__GET_VAR(RES0__INST0.FINISHED,))
        return 2;
    printf("Failed = %d\\n", (int)__GET_VAR(RES0__INST0.FAULTS,));
    return 0;
}}
"""
SOUND: Final = "Failed = 0"


def st_checks(book: Tuned) -> Iterator[Check]:
    """The check, or why it could not be made."""
    translator, compiler = shutil.which(TRANSLATOR), shutil.which("cc") or shutil.which("gcc")
    if not book.content:
        yield not_checked(WHAT, HOW, "the tune failed", LIMIT)
    elif translator is None or compiler is None:
        absent = TRANSLATOR if translator is None else "a C compiler"
        yield not_checked(WHAT, HOW, f"not on PATH: {absent}", LIMIT, REMEDY)
    elif (library := library_of(translator)) is None:
        yield not_checked(WHAT, HOW, f"the folder lib of {translator} was not found", LIMIT, REMEDY)
    else:
        said = self_test(translator, compiler, library, book)
        yield checked(WHAT, HOW, said, LIMIT, said == SOUND)


def library_of(translator: str) -> Path | None:
    """The folder with MATIEC's own blocks; None where it is neither beside the translator nor named."""
    named = os.environ.get(LIBRARY)
    folder = Path(named) if named else Path(translator).resolve().parent / "lib"
    return folder if (folder / "ieclib.txt").is_file() else None


def self_test(translator: str, compiler: str, library: Path, book: Tuned) -> str:
    """What the self-test says, or what kept it from being run."""
    folder = book.folder.parent / "st"
    exported = program(f"export {book.folder.name} --format st -o {folder.name}", folder.parent)
    if exported.code != 0:
        return exported.sentence
    texts = [(folder / name).read_text("ascii") for name in ("retarder_table.st", "retarder_self_test.st")]
    (folder / "try.st").write_text("\n".join([*texts, CONFIGURATION]), "ascii")
    (folder / "main.c").write_text(MAIN, "ascii")
    translated = process([translator, "-I", str(library), "try.st"], folder)
    if translated.code != 0 or translated.err.strip():
        return f"{TRANSLATOR}: {first_complaint(translated)}"
    switches = ["-w", "-ffp-contract=off", f"-I{library / 'C'}", "-I.", "-o", "try"]
    built = process([compiler, *switches, "main.c", "CONFIG0.c", "RES0.c"], folder)
    if built.code != 0:
        return f"{compiler}: {first_complaint(built)}"
    ran = process([str(folder / "try")], folder)
    return ran.out.strip() or ran.sentence
