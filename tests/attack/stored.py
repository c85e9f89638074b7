"""Kinds of files that commands store and read again: tables, sweeps, logs, trains of a hump.

What is changed in them is changed under sums that are right, as by one who knows how.
"""

from __future__ import annotations

import hashlib
import io
import json
import random
import tempfile
import zipfile
from collections.abc import Callable, Iterator, Mapping
from contextlib import suppress
from dataclasses import fields, replace
from functools import partial
from pathlib import Path
from typing import Any, Final, TypeVar

import numpy as np

from synth.cli.inspect import inspect_command
from synth.frame.faults import InputError
from synth.frame.terminal.manner import Manner
from synth.hump.configuration.trial_file import parse_trial_file
from synth.hump.rolling.outcomes import TrainOutcomes
from synth.hump.trains.outcome_file import stored_trains, to_npz, trains_of
from synth.hump.trial.made_trial import made_trial
from synth.hump.trial.resolved_trial import resolve_trial
from synth.retarder.comparison.measured import Judgement
from synth.retarder.failed_case import FailedCase
from synth.retarder.forms.code_options import code_options
from synth.retarder.forms.table_forms import FORMS
from synth.retarder.forms.tables_at import tables_at
from synth.retarder.sweep.plan import Gap
from synth.retarder.sweep.unit_result import Row, UnitResult, from_bytes, to_bytes
from synth.simulation.exit_statistics import BrakePower, ExitStatistics
from tests.attack.forged import forged
from tests.attack.mutants import mutant
from tests.attack.processes import Changed, Kind, Reading
from tests.tuning_tables.every_kind import SAMPLES, altered, document_of, places, sealed, value_at, whole_lines
from tests.tuning_tables.passages.made_tables import table_of
from tuning_tables import InvalidTable, write_book
from tuning_tables.document import StageTable
from tuning_tables.json_text import document_checksum
from tuning_tables.passages.sensor_layout import DecidesOn
from tuning_tables.whole_file import SEAL_BYTES, seal_of

Figures = TypeVar("Figures", ExitStatistics, BrakePower)

EXPORTED: Final = ("c", "st", "csv", "json")
VALUES: Final[tuple[Any, ...]] = (
    *(None, True, False, 0, -1, 1, 2, 0.0, -0.0, 1.5, 1e308, -1e308, 5e-324, 2**53, 2**63, 10**400),
    *("", "x", "x" * 3000, "a\nb", "\u202e", "\ud800", "=1+1", "../x", [], {}, [[]], [1.0], [None], {"x": 1}),
)


def read_tables(folder: Path, name: str) -> str:
    """As `inspect`, then `export`, of which each table may be right and all together make none."""
    inspect_command(folder / name, None, Manner())
    tables = tables_at(folder / name).of_one_kind
    for form in EXPORTED:
        with suppress(InputError, InvalidTable):
            FORMS[form](tables, code_options(form, None, None, False, None))
    return repr(tables)


def book_kind(tables: tuple[StageTable, ...]) -> Kind:
    """A book."""
    with tempfile.TemporaryDirectory() as folder:
        write_book(tables, Path(folder, "book.h5"), tables[0].generator)
        content = Path(folder, "book.h5").read_bytes()
    return Kind("book", {"book.h5": content}, "book.h5", partial(read_tables, name="book.h5"), forged, code=3)


def in_document(document: dict[str, Any], dice: random.Random) -> dict[str, Any]:
    """One to three members are another value, missing, or that of another member."""
    for _ in range(dice.choice((1, 1, 2, 3))):
        every = list(places(document))
        if every:
            other = dice.choice((*VALUES, value_at(document, dice.choice(every))))
            document = altered(document, dice.choice(every), other)
    return document


def whole_number(digits: str) -> float:
    """As canonical JSON tells it: beyond 2^53 it is a float."""
    return int(digits) if abs(int(digits)) < 2**53 else float(digits)


def sealed_change(content: bytes, dice: random.Random) -> bytes:
    """A table whose document is changed."""
    try:
        return sealed(in_document(json.loads(content, parse_int=whole_number), dice))
    except (ValueError, TypeError):  # no JSON can hold it
        return content


def table_kind(name: str) -> Kind:
    """A table by itself."""
    content = sealed(document_of(SAMPLES[name]()))
    return Kind(name, {"t.json": content}, "t.json", partial(read_tables, name="t.json"), sealed_change, code=3)


def figures_of(kind: type[Figures]) -> Figures:
    """Any figures of that kind: the intervals are (0.1, 0.2)."""
    values: dict[str, Any] = {each.name: (0.1, 0.2) if "ci95" in each.name else 0.1 for each in fields(kind)}
    return kind(**values | ({"passes": 1000} if "passes" in values else {}))


def unit_change(content: bytes, dice: random.Random) -> bytes:
    """A result of a unit whose document is changed; sometimes its table has the right sum again."""
    document = in_document(json.loads(content[:-SEAL_BYTES]), dice)
    with suppress(Exception):
        if dice.random() < 0.5:
            table = document["rows"][0]["table"]
            table["crc32"] = document_checksum(table)
    body = json.dumps(document).encode()
    return body + seal_of(body)


def read_unit(folder: Path) -> str:
    """As `sweep run`, when it goes on."""
    return repr(from_bytes((folder / "unit.json").read_bytes(), str(folder / "unit.json")))


def unit_kind() -> Kind:
    """The result of a unit of a sweep."""
    table = replace(whole_lines(), validated=None)
    row = Row(table, figures_of(ExitStatistics), figures_of(BrakePower), Judgement(("rms",), ()))
    gaps = (Gap(1.0, 2.0, 0.1, 0.2, refined=False),)
    content = to_bytes(UnitResult("k", "wet", "label", (row,), gaps, (FailedCase("label", 1.5, "reason"),)))
    return Kind("unit", {"unit.json": content}, "unit.json", read_unit, unit_change, code=3)


STORED: Final[Mapping[str, Callable[[], Kind]]] = {
    "forged-book": lambda: book_kind((whole_lines(), replace(whole_lines(), id="other", target_speed_m_s=3.0))),
    "forged-passages": lambda: book_kind((table_of(), replace(table_of(DecidesOn.EVERY_AXLE), id="every"))),
    **{f"forged {name}": partial(table_kind, name) for name in SAMPLES},
    "forged-unit": unit_kind,
}


NUMBER: Final = 4
DAMAGED: Final = 500
"""Archives that are damaged at random and then sealed: nothing else comes to what is behind a seal."""
CONFIG: Final = f"""\
hump = "medium"
[trains]
number = {NUMBER}
cuts = 3
[hump_speed]
constant_m_s = 1.5
[aim]
design_cuts = 200
"""


def read_trains(folder: Path) -> str:
    """As `computer`: the hash of all outcomes."""
    found = stored_trains(folder, str(folder)).found
    arrays = [np.asarray(getattr(found, field.name)) for field in fields(TrainOutcomes)]
    return hashlib.sha256(b"".join(f"{a.dtype} {a.shape}".encode() + a.tobytes() for a in arrays)).hexdigest()


def trains_kind() -> Kind:
    """Trains of a small trial; a changed file is refused with 3, or has the same trains."""
    config = resolve_trial(parse_trial_file(CONFIG, "trial.toml"))
    content = to_npz(
        made_trial(config).batch(0, NUMBER),
        trains_of(config),
    )
    return Kind(
        name="trains",
        files={"inputs/config.toml": CONFIG.encode(), "trains.npz": content},
        attacked="trains.npz",
        read=read_trains,
        change=partial(mutant, text=False),
        code=3,
        allowed=Reading.SAME,
        first=tuple(forged_archives(content)),
    )


def forged_archives(content: bytes) -> Iterator[Changed]:
    """Archives that are sound but for one of their arrays; each without and with a seal that fits."""
    with zipfile.ZipFile(io.BytesIO(content)) as archive:
        members = {name: archive.read(name) for name in archive.namelist()}
    cuts = np.load(io.BytesIO(members["cuts.npy"]))
    arrays = {
        "zip bomb": npy(np.zeros(8_000_000, dtype=np.int64)),
        "terabytes promised": npy(cuts).replace(b"(4,), }            ", b"(4000000000000,), }"),
        "longer": npy(np.append(cuts, cuts)),
        "empty": npy(cuts[:0]),
        "another shape": npy(cuts.reshape(2, 2)),
        "another type": npy(cuts.astype(np.float32)),
        "texts": npy(cuts.astype(np.str_)),
        "objects": npy(cuts.astype(object)),
        "no array": b"PK",
    }
    for how, array in arrays.items():
        body = packed({**members, "cuts.npy": array})
        yield Changed(body, how, Reading.SAME)
        yield Changed(body + seal_of(body), f"{how}, sealed", Reading.SAME)
    yield Changed(packed({**members, "cuts.npy": npy(cuts + 1)}), "other numbers", Reading.SAME)
    sound = packed(members)
    for number in range(DAMAGED):
        body = mutant(sound, random.Random(number), text=False)
        yield Changed(body + seal_of(body), "damaged, sealed", Reading.SAME)


def npy(array: np.ndarray[Any, Any]) -> bytes:
    """An array as numpy stores it."""
    file = io.BytesIO()
    np.save(file, array)
    return file.getvalue()


def packed(members: dict[str, bytes]) -> bytes:
    """An archive."""
    file = io.BytesIO()
    with zipfile.ZipFile(file, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, content in members.items():
            archive.writestr(name, content)
    return file.getvalue()
