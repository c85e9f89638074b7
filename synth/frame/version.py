"""Which version of the program this is, which defects released versions had and which tables were made by one that
has them, and when results were made: the one date that stands in files. The standard library alone.
"""

from __future__ import annotations

import json
import os
import re
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from datetime import UTC, datetime
from importlib.metadata import version
from pathlib import Path
from typing import Any, Final, TypeAlias

from synth.frame.faults import InputError

__version__: Final = version("retarder-synth")


Document: TypeAlias = Mapping[str, Any]
"""A table as its JSON file says it, or code of tables of a `kind`, by its name as `id`."""

PLACE: Final = Path(__file__).with_name("KNOWN-DEFECTS.json")
OWN: Final = "retarder-synth"
MADE, EXPORTED = "made", "exported"
NUMBERS: Final = re.compile(r"\d+(\.\d+)*")


@dataclass(frozen=True)
class Defect:
    """A defect of the versions from `introduced` on, before `fixed`, or of all that follow where that is None.

    `kinds`: of the tables that it spoils; `steps`: those that such a version `MADE`, or `EXPORTED`. `unsafe`: a cut may
    leave faster than the table says. `wrong`, `effect`, `detect` and `remedy` are for people: what is wrong, what it
    does at the retarder, how to find out whether a table has it, and what to do.
    """

    id: str
    introduced: str
    fixed: str | None
    kinds: tuple[str, ...]
    steps: tuple[str, ...]
    unsafe: bool
    wrong: str
    effect: str
    detect: str
    remedy: str

    def concerns(self, table: Document) -> bool:
        """Whether a version with this defect made the table, or exported it, as far as that is told."""
        made_by = table.get("generator", {})
        exporter, _, exporting = table.get("exported_by", "").partition(" ")
        programs = {MADE: (made_by.get("name"), made_by.get("version")), EXPORTED: (exporter, exporting)}
        found = (programs[step] for step in self.steps)
        return table["kind"] in self.kinds and any(self.is_in(version) for name, version in found if name == OWN)

    def is_in(self, version: str) -> bool:
        """Whether this version of the program has it; so it is taken where the version is none of ours."""
        told = release(version)
        is_fixed = self.fixed is not None and told >= release(self.fixed)
        return not told or (told >= release(self.introduced) and not is_fixed)


@dataclass(frozen=True)
class Concerned:
    """A defect and the tables that a version with it made, by id."""

    defect: Defect
    tables: tuple[str, ...]

    @property
    def sentence(self) -> str:
        """The warning."""
        each, count = self.defect, len(self.tables)
        named = self.tables[0] if count == 1 else f"{count} of these"
        return (
            f"known defect {each.id}{', unsafe' if each.unsafe else ''}: a version that has it made or exported "
            f"{named}: {each.wrong}; what it does: {each.effect}; how to find it: {each.detect}; what to do: "
            f"{each.remedy}"
        )

    @property
    def document(self) -> dict[str, Any]:
        """It for programs."""
        return {
            "id": self.defect.id,
            "unsafe": self.defect.unsafe,
            "tables": list(self.tables),
            "sentence": self.sentence,
        }


def known_defects() -> tuple[Defect, ...]:
    """All that were known when this version was made."""
    listed = json.loads(PLACE.read_text(encoding="utf-8"))["defects"]
    return tuple(Defect(**{**each, "kinds": tuple(each["kinds"]), "steps": tuple(each["steps"])}) for each in listed)


def concerned(tables: Callable[[], Iterable[Document]]) -> tuple[Concerned, ...]:
    """The known defects, each with those of the tables that it concerns; none is looked at where no defect is known."""
    defects = known_defects()
    told = [*tables()] if defects else []
    found = (Concerned(each, tuple(table["id"] for table in told if each.concerns(table))) for each in defects)
    return tuple(each for each in found if each.tables)


def release(version: str) -> tuple[int, ...]:
    """The numbers that a version begins with, less zeros at their end; none where it begins with no number."""
    numbers = NUMBERS.match(version)
    found = [int(each) for each in numbers[0].split(".")] if numbers else []
    while len(found) > 1 and not found[-1]:
        found.pop()
    return tuple(found)


def creation_time() -> str:
    """Now in UTC, or the time of SOURCE_DATE_EPOCH (which makes a run's files reproducible to the byte)."""
    epoch = os.environ.get("SOURCE_DATE_EPOCH")
    moment = datetime.fromtimestamp(int(epoch), UTC) if epoch else datetime.now(UTC)
    return moment.strftime("%Y-%m-%dT%H:%M:%SZ")


def require_date() -> None:
    """`InputError` if SOURCE_DATE_EPOCH is set to what is no time."""
    text = os.environ.get("SOURCE_DATE_EPOCH")
    try:
        if text:
            datetime.fromtimestamp(int(text), UTC)
    except (OSError, OverflowError, ValueError):
        raise InputError(f"SOURCE_DATE_EPOCH is {text!r}; it must be whole seconds since 1970") from None
