"""What every command leaves in its smallest form, kept, and how two runs differ."""

from __future__ import annotations

import difflib
import hashlib
import json
import os
import subprocess
import sys
from collections.abc import Iterator, Mapping
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

from tests.golden.orders import INPUTS, Order

PROGRAM = (sys.executable, "-c", "import sys; from synth.cli import main; raise SystemExit(main(sys.argv[1:]))")
SURROUNDINGS = {"SOURCE_DATE_EPOCH": "1700000000", "COLUMNS": "120", "OPENBLAS_NUM_THREADS": "1", "NO_COLOR": "1"}
HELD = ".retarder-synth"
"""The file that marks a folder of results."""


@dataclass(frozen=True)
class Record:
    """What one order came to.

    `printed`: stdout, then stderr, of which progress is left out. `files`: SHA-256 of every file by its path, but of
    a JSON document, whose leaves stand in `leaves` by file and path: numbers, texts, true, false, null.
    """

    code: int
    printed: str
    files: Mapping[str, str]
    leaves: Mapping[str, Any]


def recorded(order: Order, folder: Path) -> Record:
    """Run `order` in `folder`, where the inputs and what earlier orders left are."""
    words = [*PROGRAM, *order.line.split()]
    environment = {**os.environ, **SURROUNDINGS}
    done = subprocess.run(words, capture_output=True, text=True, cwd=folder, env=environment, check=False)
    printed = (done.stdout + done.stderr).replace(str(folder), "")
    files: dict[str, str] = {}
    leaves: dict[str, Any] = {}
    for path in sorted(written_to(folder / order.output)) if order.output else ():
        name, content = path.relative_to(folder).as_posix(), path.read_bytes()
        document = parsed(content) if path.suffix == ".json" else None
        if document is None:
            files[name] = hashlib.sha256(content).hexdigest()
        else:
            leaves |= {f"{name}: {place}": leaf for place, leaf in leaves_of(document, "")}
    return Record(done.returncode, printed, files, leaves)


def parsed(content: bytes) -> Any:
    """A JSON document; None for what is none, as a file of one document a line is."""
    try:
        return json.loads(content)
    except ValueError:
        return None


def written_to(output: Path) -> Iterator[Path]:
    """Every file that a command left in the folder `output`, or that file."""
    if output.is_file():
        yield output
    yield from (path for path in output.rglob("*") if path.is_file() and path.name != HELD)


def leaves_of(document: Any, place: str) -> Iterator[tuple[str, Any]]:
    """Every number, text, true, false and null of a JSON document by its place, "cases.0.rms_m_s"."""
    if isinstance(document, Mapping):
        children: Any = document.items()
    elif isinstance(document, list):
        children = enumerate(document)
    else:
        yield place, document
        return
    for key, child in children:
        yield from leaves_of(child, f"{place}.{key}" if place else str(key))


def write_inputs(folder: Path) -> None:
    """The configurations that the orders name."""
    for name, text in INPUTS.items():
        (folder / name).write_text(text, encoding="utf-8")


def document_of(records: Mapping[str, Record]) -> bytes:
    """The records by order, as JSON."""
    return json.dumps({line: asdict(record) for line, record in records.items()}, indent=1, sort_keys=True).encode()


def records_of(document: bytes) -> dict[str, Record]:
    """What `document_of` wrote."""
    return {line: Record(**record) for line, record in json.loads(document).items()}


Renamed = Mapping[str, str]
"""How places and files of the run before begin → how they begin now."""


def differences(before: Mapping[str, Record], now: Mapping[str, Record], renamed: Renamed) -> Iterator[str]:
    """Every difference: orders, exit codes, files by name and hash, leaves by place and value, printed lines."""
    for line in sorted({*before, *now}):
        if line not in now or line not in before:
            yield f"{line}: {'only before' if line in before else 'only now'}"
        else:
            yield from (f"{line}: {found}" for found in between(before[line], now[line], renamed))


def between(before: Record, now: Record, renamed: Renamed) -> Iterator[str]:
    """Of one order."""
    if before.code != now.code:
        yield f"exit code {before.code} → {now.code}"
    yield from changed(moved(before.files, renamed), now.files)
    yield from changed(moved(before.leaves, renamed), now.leaves)
    lines = difflib.unified_diff(before.printed.splitlines(), now.printed.splitlines(), n=0, lineterm="")
    yield from (each for each in lines if each[:3] not in ("---", "+++"))


def moved(entries: Mapping[str, Any], renamed: Renamed) -> dict[str, Any]:
    """`entries` with their names of now; of several beginnings that fit the longest counts."""
    found = {}
    for name, value in entries.items():
        beginning = max((each for each in renamed if name.startswith(each)), key=len, default="")
        found[renamed.get(beginning, "") + name[len(beginning) :]] = value
    return found


def changed(before: Mapping[str, Any], now: Mapping[str, Any]) -> Iterator[str]:
    """Entries that came, went, or have another value; of two numbers, by how much."""
    for name in sorted({*before, *now}):
        if name not in now or name not in before:
            yield f"{name} {'is gone' if name in before else 'is new'}"
        elif before[name] != now[name] or type(before[name]) is not type(now[name]):
            yield f"{name}: {before[name]!r} → {now[name]!r}"
