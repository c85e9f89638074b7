"""The tables of the documentation, from the kept results of studies.

In a checkout docs/studies holds NAME.json, the result of a run with default options, for every study that a document
shows. Between <!-- study NAME TABLE --> and <!-- end --> stands that table of it; between <!-- studies --> and
<!-- end --> the list of all studies. Pictures: `document_pictures`; keys of a configuration: `document_keys`.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from functools import cache
from pathlib import Path

from plant_models.library.near_miss import near_miss
from scripts.studies.document_keys import keys_of
from scripts.studies.document_pictures import is_stale, pictures_of, write_picture
from scripts.studies.markdown_table import table
from scripts.studies.named_study import study_named
from scripts.studies.registry import STUDIES
from scripts.studies.result import Result, read_result
from synth.frame.input_error import InputError

KEPT = Path("docs/studies")
END = "<!-- end -->"

_MARKED = re.compile(
    r"<!-- (?:study (?P<study>\S+) (?P<table>\S+)|keys (?P<keys>\S+)|(?P<list>studies)) -->\n(?P<old>.*?)(?=<!-- )",
    re.S,
)


def documents(root: Path) -> Iterator[Path]:
    """README.md and every page of docs/. Raises `InputError` where `root` is no checkout."""
    if not (root / KEPT).is_dir():
        raise InputError(f"{root}: there is no {KEPT} here; run the command in a checkout of retarder-synth")
    yield root / "README.md"
    yield from sorted((root / "docs").glob("*.md"))


def kept(root: Path, name: str) -> Path:
    """Where the result of the study `name` is kept."""
    return root / KEPT / f"{name}.json"


def filled(path: Path, root: Path) -> str:
    """The text of the document `path` with every marked table as the kept results have it. Raises `InputError`."""
    text = path.read_text(encoding="utf-8")

    def new(found: re.Match[str]) -> str:
        if not text.startswith(END, found.end()):
            raise InputError(f"{path}: the table after {found[0].splitlines()[0]} has no {END} behind it; add it")
        if found["list"]:
            return f"<!-- studies -->\n{listed()}"
        if found["keys"]:
            return f"<!-- keys {found['keys']} -->\n{keys_of(found['keys'])}"
        return (
            f"<!-- study {found['study']} {found['table']} -->\n{table_of(root, path, found['study'], found['table'])}"
        )

    return _MARKED.sub(new, text)


def table_of(root: Path, path: Path, study: str, name: str) -> str:
    """The table `name` of the kept result of `study`, for the document `path`."""
    tables = result_of(root, study).findings.tables()
    if name not in tables:
        raise InputError(f"{path}: the study {study} has no table {name!r}; {near_miss(name, tables)}")
    return tables[name].markdown()


@cache
def result_of(root: Path, name: str) -> Result:
    """The kept result of the study `name`."""
    return read_result(study_named(name), kept(root, name))


def listed() -> str:
    """All studies: name, question, time, page."""

    def link(page: str) -> str:
        return f"[{page.partition('.')[0].replace('-', ' ')}]({page})" if page else ""

    rows = ((f"`{s.name}`", s.question, s.duration, link(s.page)) for s in STUDIES)
    return table("studies", ("study", "answers", "takes", "stands in"), rows).markdown()


def written(root: Path) -> list[Path]:
    """Fill all documents; those that changed."""
    result_of.cache_clear()
    changed = []
    for path in documents(root):
        text = filled(path, root)
        if text != path.read_text(encoding="utf-8"):
            path.write_text(text, encoding="utf-8")
            changed.append(path)
        for study, name, file in pictures_of(path):
            result = result_of(root, study)
            if is_stale(file, result, name):
                write_picture(file, result, name)
                changed.append(file)
    return changed


def stale(root: Path) -> list[str]:
    """A sentence for every document whose tables, and every picture that, are not those of the kept results."""
    result_of.cache_clear()
    mend = "'retarder-synth study --document' writes them"
    found = []
    for path in documents(root):
        if filled(path, root) != path.read_text(encoding="utf-8"):
            found.append(f"{path.relative_to(root)}: its tables are not those of {KEPT}; {mend}")
        found += [
            f"{file.relative_to(root)}: this is not the picture that {KEPT}/{study}.json gives; {mend}"
            for study, name, file in pictures_of(path)
            if is_stale(file, result_of(root, study), name)
        ]
    return found
