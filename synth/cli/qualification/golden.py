"""What the two small books are on the processors where they were kept, and how far those of another one may be off."""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from importlib.resources import files
from typing import Any, Final

from synth.cli.qualification.check import Check, checked
from synth.cli.qualification.tuned import Tuned

OTHER_PROCESSOR: Final = 0.01
"""Relative difference of an rms on a kind of processor, or with libraries, whose bytes are not kept.

Sums end there in other last bits, so a search for the best lines ends beside where it ended elsewhere.
"""

FIGURES: Final = {"predicted": "predicted rms", "validated": "simulated rms"}


@dataclass(frozen=True)
class Golden:
    """A book as it was kept: SHA-256 of its tables by kind of processor, and rms in m/s of its table by member."""

    sha256: Mapping[str, str]
    rms_m_s: Mapping[str, float]


def kept() -> dict[str, Golden]:
    """The books by kind."""
    document: dict[str, Any] = json.loads((files("synth.cli.qualification") / "golden.json").read_bytes())
    return {kind: Golden(**entry) for kind, entry in document.items()}


def golden_of(book: Tuned) -> Golden:
    """What is to be kept of a book on this kind of processor, whose name is not known here: ""."""
    return Golden({"": book.sha256}, {key: book.document[key]["rms_m_s"] for key in FIGURES})


def golden_checks(books: Sequence[Tuned]) -> Iterator[Check]:
    """Whether each book is the kept one."""
    golden = kept()
    for book in books:
        if book.tables:
            yield golden_check(book, golden[book.kind])


def golden_check(book: Tuned, golden: Golden) -> Check:
    """By its bytes; where they are of no kept kind, by its figures."""
    what = f"Tune, {book.kind} speed: golden bytes"
    how = "SHA-256 of the tables of a small problem against those kept in the program"
    kinds = [kind for kind, sha256 in golden.sha256.items() if sha256 == book.sha256]
    if kinds:
        return checked(what, how, f"the bytes of processors {' and '.join(kinds)}", "equal", True)
    found = golden_of(book).rms_m_s
    off = max(abs(found[key] / golden.rms_m_s[key] - 1.0) for key in FIGURES)
    told = "; ".join(f"{name} {found[key]:.4f} m/s, {golden.rms_m_s[key]:.4f} kept" for key, name in FIGURES.items())
    limit = f"equal; on other processors, or with other libraries, each rms within {100 * OTHER_PROCESSOR:g} %"
    said = f"other bytes ({book.sha256[:16]}…) than on processors {' or '.join(golden.sha256)}: {told}"
    return checked(what, how, said, limit, off <= OTHER_PROCESSOR)
