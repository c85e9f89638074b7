"""What is shown of a qualification: the checks, and what they hold for."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Final

from synth.cli.qualification.check import Check, Outcome
from synth.cli.qualification.machine import machine_rows, version_rows
from synth.cli.qualification.qualified import Qualified
from synth.frame.command import Limit
from synth.frame.exhibits import Chapter, Column, File, Row, Sentence, Table
from synth.frame.printed_numbers import counted

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
