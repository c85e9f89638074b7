"""The tables of the documentation, from the kept results of studies, and the page of docs/data/ that holds all
tables of one study: each behind a fold, with the sentence that it tells.

In a checkout docs/studies holds NAME.json, the result of a run with default options, for every study that the
documentation shows; docs/data/NAME.md holds all its tables, folded. A document shows a table of few rows
itself: between <!-- study NAME TABLE --> and <!-- end -->. Between <!-- studies --> and <!-- end --> stands the list of
all studies. Pictures: `document_pictures`; keys of a configuration: `document_keys`; what crosses
the cable of `bench`: its `wires`.
"""

from __future__ import annotations

import os
import re
from collections.abc import Iterator
from functools import cache
from pathlib import Path
from typing import Final

from plant_models.errors import near_miss
from scripts.studies.document_parts import is_stale, keys_of, pictures_of, write_picture
from scripts.studies.registry import STUDIES, study_named
from scripts.studies.result import Result, read_result
from scripts.studies.study import MarkdownTable, Study, table
from synth.frame.faults import InputError
from synth.retarder.bench.wires import COMMAND_WIRES, TOLD_WIRES


def data_page(result: Result) -> str:
    """The page of the kept `result`: its question, how it is run again, its tables, what is told besides."""
    return "\n".join(parts_of(result))


def parts_of(result: Result) -> Iterator[str]:
    """The page, part by part."""
    study = result.study
    yield f"# {study.name}\n\n{study.question}\n"
    again = f"`retarder-synth study {study.name} --document` makes this page again in {study.duration}."
    page, _, anchor = study.page.partition("#")
    if page:
        link = f"../{page}#{anchor}" if anchor else f"../{page}"
        again += f" What it means: [{page.rpartition('/')[2].removesuffix('.md').replace('-', ' ')}]({link})."
    yield f"{again}\n"
    for name, each in result.findings.tables().items():
        yield folded(name, each)
    told = (*result.findings.sentences(), *result.findings.faults())
    if told:
        yield "".join(f"- {sentence}\n" for sentence in told)


def folded(name: str, each: MarkdownTable) -> str:
    """The heading `name`, the sentence of the table, and the table behind it."""
    return f"## {name}\n\n<details>\n<summary>{each.title}</summary>\n\n{each.markdown()}\n</details>\n"


PAGES = Path("docs")
KEPT = PAGES / "studies"
DATA = PAGES / "data"
SOURCES = PAGES / "reference" / "sources.md"
END = "<!-- end -->"

_MARKED = re.compile(
    r"<!-- (?:study (?P<study>\S+) (?P<table>\S+)|keys (?P<keys>\S+)|(?P<wires>wires)|(?P<list>studies)) -->\n"
    r"(?P<old>.*?)(?=<!-- )",
    re.S,
)


def documents(root: Path) -> Iterator[Path]:
    """README.md and every page of docs/ that is written by hand. Raises `InputError` where `root` is no checkout."""
    if not (root / KEPT).is_dir():
        raise InputError(f"{root}: there is no {KEPT} here; run the command in a checkout of retarder-synth")
    yield root / "README.md"
    made = {data_file(root, result.stem) for result in (root / KEPT).glob("*.json")}
    yield from sorted(page for page in (root / PAGES).rglob("*.md") if page not in made)


def kept(root: Path, name: str) -> Path:
    """Where the result of the study `name` is kept."""
    return root / KEPT / f"{name}.json"


WIRES: Final = ("register", "node", "type", "unit", "is")


def wire_rows() -> Iterator[tuple[str, ...]]:
    """A row for each wire, for people: what the position tells, then what the controller writes."""
    for wire in (*TOLD_WIRES, *COMMAND_WIRES):
        last = wire.address + wire.words.registers - 1
        place = str(wire.address) if last == wire.address else f"{wire.address}–{last}"
        yield place, f"`{wire.name}`", wire.words.shown, wire.variable.unit or "", wire.variable.meaning


def filled(path: Path, root: Path) -> str:
    """The text of the document `path` with every marked table as the kept results have it. Raises `InputError`."""
    text = path.read_text(encoding="utf-8")
    sources = os.path.relpath(root / SOURCES, path.parent)

    def new(found: re.Match[str]) -> str:
        if not text.startswith(END, found.end()):
            raise InputError(f"{path}: the table after {found[0].splitlines()[0]} has no {END} behind it; add it")
        if found["list"]:
            return f"<!-- studies -->\n{listed(path.parent, root)}"
        if found["wires"]:
            return f"<!-- wires -->\n{table('wires', WIRES, wire_rows()).markdown()}"
        if found["keys"]:
            return f"<!-- keys {found['keys']} -->\n{keys_of(found['keys'], sources)}"
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


def listed(folder: Path, root: Path) -> str:
    """All studies, for a page in `folder`: name, question, time, all its tables, the page that reads them."""

    def link(text: str, file: Path, anchor: str = "") -> str:
        return f"[{text}]({os.path.relpath(file, folder)}{anchor})"

    def row(study: Study) -> tuple[str, ...]:
        data = link("tables", data_file(root, study.name)) if kept(root, study.name).is_file() else ""
        page, mark, anchor = study.page.partition("#")
        reads = link(Path(page).stem.replace("-", " "), root / PAGES / page, mark + anchor) if page else ""
        return f"`{study.name}`", study.question, study.duration, data, reads

    return table("studies", ("study", "answers", "takes", "found", "read in"), map(row, STUDIES)).markdown()


def data_file(root: Path, name: str) -> Path:
    """Where all tables of the study `name` stand."""
    return root / DATA / f"{name}.md"


def texts(root: Path) -> Iterator[tuple[Path, str]]:
    """Every page of the documentation with tables, and what should stand in it."""
    for path in documents(root):
        yield path, filled(path, root)
    for result in sorted((root / KEPT).glob("*.json")):
        yield data_file(root, result.stem), data_page(result_of(root, result.stem))


def written(root: Path) -> list[Path]:
    """Fill all documents; those that changed."""
    result_of.cache_clear()
    changed = []
    for path, text in texts(root):
        if not path.is_file() or text != path.read_text(encoding="utf-8"):
            path.parent.mkdir(exist_ok=True)
            path.write_text(text, encoding="utf-8")
            changed.append(path)
    for path in documents(root):
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
    for path, text in texts(root):
        if not path.is_file() or text != path.read_text(encoding="utf-8"):
            found.append(f"{path.relative_to(root)}: its tables are not those of {KEPT}; {mend}")
    for path in documents(root):
        found += [
            f"{file.relative_to(root)}: this is not the picture that {KEPT}/{study}.json gives; {mend}"
            for study, name, file in pictures_of(path)
            if is_stale(file, result_of(root, study), name)
        ]
    return found
