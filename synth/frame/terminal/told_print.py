"""A run on stdout: what is brief of its exhibits, the verdict, and where the files are."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from pathlib import Path

from synth.frame.exhibits import Exhibit as Shown
from synth.frame.exhibits import Sentence, Table, exhibits_of
from synth.frame.terminal.printed_page import Printed, PrintedVerdict
from synth.frame.terminal.printed_table import PrintedTable
from synth.frame.told import Told


def page_of_run(told: Told, directory: Path, files: Sequence[str]) -> Iterator[Printed]:
    """What is printed of it; `files`: names of what was written."""
    yield from printed(told)
    yield f"{directory}: {', '.join(folders_and_files(files))}"


def printed(told: Told) -> Iterator[Printed]:
    """The brief exhibits in their order, then the verdict."""
    yield from brief_exhibits(exhibits_of(told.chapters), "summary.json")
    if told.verdict.limits:
        yield PrintedVerdict(told.verdict.kept, told.verdict.sentence)


def brief_exhibits(exhibits: Iterable[Shown], elsewhere: str) -> Iterator[Printed]:
    """Those that a terminal shows; `elsewhere` names the place of what it has no room for."""
    for each in exhibits:
        if isinstance(each, Sentence) and each.brief:
            yield each.text
        if isinstance(each, Table) and each.brief:
            yield PrintedTable(each, elsewhere)


def folders_and_files(names: Sequence[str]) -> list[str]:
    """The folders, then the files beside them."""
    folders = sorted({f"{name.partition('/')[0]}/" for name in names if "/" in name})
    return [*folders, *sorted(name for name in names if "/" not in name)]
