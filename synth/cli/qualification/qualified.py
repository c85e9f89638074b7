"""All checks of a qualification, made one after the other in a folder that is removed, and what is shown of them."""

from __future__ import annotations

import tempfile
from collections.abc import Callable, Iterable, Iterator, Mapping
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path
from typing import Final

from synth.cli.qualification.any_time import any_time_checks
from synth.cli.qualification.c_code import c_checks
from synth.cli.qualification.check import Check, Outcome
from synth.cli.qualification.golden import golden_checks, plain_checks, tune_checks
from synth.cli.qualification.installed import (
    Installed,
    defect_check,
    libraries,
    library_check,
    machine_rows,
    own_content,
    program_check,
    version_rows,
)
from synth.cli.qualification.second_program import loop_check, planted_checks, prediction_check, verify_check
from synth.cli.qualification.structured_text import st_checks
from synth.cli.qualification.tuned import ESTIMATED, MEASURED, tuned_twice
from synth.frame.command import Limit
from synth.frame.exhibits import Chapter, Column, File, Row, Sentence, Table
from synth.frame.printed_numbers import counted
from synth.frame.version import known_defects

STEPS: Final = 6


@dataclass(frozen=True)
class Qualified:
    """The checks in their order, the program and its libraries, and the files of the two books by name."""

    checks: tuple[Check, ...]
    packages: tuple[Installed, ...]
    files: Mapping[str, bytes]

    def having(self, outcome: Outcome) -> tuple[Check, ...]:
        """The checks that come to `outcome`."""
        return tuple(check for check in self.checks if check.outcome is outcome)


def qualified(done: Callable[[str], None]) -> Qualified:
    """Make all checks; `done` is told each of the STEPS."""
    checks: list[Check] = []

    def add(step: str, found: Iterable[Check]) -> None:
        checks.extend(found)
        done(step)

    found = libraries()
    add("files", (program_check(), library_check(found), defect_check(known_defects())))
    with tempfile.TemporaryDirectory(prefix="retarder-synth-") as folder, ThreadPoolExecutor(2) as pool:
        usual, plain = tuned_twice(Path(folder))
        books = {book.kind: book for book in usual}
        add("kernels", (*tune_checks(usual), *golden_checks(usual), *plain_checks(usual, plain)))
        measured, estimated = books[MEASURED], books[ESTIMATED]
        add("second simulator", (prediction_check(measured), *pool.map(loop_check, usual)))
        at_any_time = pool.submit(lambda: tuple(any_time_checks(measured)))
        add("second program", (*pool.map(verify_check, usual), *planted_checks(estimated), *at_any_time.result()))
        add("C code", c_checks(estimated))
        add("Structured Text", st_checks(estimated))
    files = {f"{book.kind}/{name}": content for book in usual for name, content in book.content.items()}
    return Qualified(tuple(checks), (own_content(), *found), files)


CHECKS: Final = (
    Column("outcome", "outcome", words=True),
    Column("what", "what", words=True),
    Column("found", "found", words=True, spare=1),
    Column("limit", "limit", words=True, detail=True),
    Column("how", "how", words=True, detail=True),
)
FACTS: Final = (Column("fact", "fact", words=True), Column("value", "value", words=True))
VERSIONS: Final = (
    Column("name", "package", words=True),
    Column("version", "version", words=True),
    Column("files", "files"),
    Column("sha256", "SHA-256 over the names and hashes of its files", words=True),
)
STOP: Final = "Use no table that was made on this machine until you know why a check failed."


def limits(found: Qualified) -> Iterator[Limit]:
    """A limit for each check that failed; else one that tells how many passed, and how many were not made."""
    failed, passed, left = (found.having(each) for each in (Outcome.FAILED, Outcome.PASSED, Outcome.NOT_CHECKED))
    yield from (Limit(f"{check.what}: {check.found}; asked: {check.limit}", False) for check in failed)
    if not failed:
        words = f"; {counted(len(left), 'check')} could not be made" if left else ""
        yield Limit(f"{counted(len(passed), 'check')} passed, none failed{words}", True)


def chapters(found: Qualified) -> Iterator[Chapter]:
    """The checks first."""
    steps = [STOP] if found.having(Outcome.FAILED) else []
    steps += [f"{each.what}: {each.remedy}." for each in found.having(Outcome.NOT_CHECKED) if each.remedy]
    yield Chapter(
        "Checks",
        (
            *(Sentence(step, to_do=True) for step in steps),
            Table("checks", "What was checked", CHECKS, [row(each) for each in found.checks], True, failed),
        ),
    )
    yield Chapter("Machine", (Table("machine", "What it holds for", FACTS, list(machine_rows())),))
    rows = list(version_rows(found.packages))
    yield Chapter("Versions", (Table("versions", "The program and its libraries", VERSIONS, rows),))
    where = "The two small books that were checked; the same commands make them again."
    yield Chapter("Evidence", (Sentence(where), *(File(name, content) for name, content in found.files.items())))


def row(check: Check) -> Row:
    """One check."""
    return {
        "outcome": check.outcome.value,
        "what": check.what,
        "found": check.found,
        "limit": check.limit,
        "how": check.how,
    }


def failed(row: Row) -> bool:
    """Whether the check of a row failed."""
    return bool(row["outcome"] == Outcome.FAILED.value)
