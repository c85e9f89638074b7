"""The small books as the compiled kernels make them and as their plain text does, what they are on the processors
where they were kept, and how far those of another one may be off.
"""

from __future__ import annotations

import json
import platform
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from importlib.metadata import version
from importlib.resources import files
from typing import Any, Final

import numpy as np

from synth.cli.qualification.check import Check, checked, not_checked
from synth.cli.qualification.tuned import Tuned
from synth.kernels.plain import VARIABLE


def tune_checks(books: Sequence[Tuned]) -> Iterator[Check]:
    """Whether each book was made, and keeps its limits."""
    for book in books:
        how, limit = "retarder-synth tune, as its user calls it", "exit code 0: the limits of its problem are kept"
        found = "; ".join(each["sentence"] for each in book.summary["limits"]) if book.content else book.ran.sentence
        yield checked(f"Tune, {book.kind} speed", how, found, limit, book.ran.code == 0)


def plain_checks(books: Sequence[Tuned], plain: Sequence[Tuned]) -> Iterator[Check]:
    """Whether the plain text makes the same files."""
    how, limit = f"the same tune with {VARIABLE}=1: nothing of numba that it does not document", "every file equal"
    for book, other in zip(books, plain, strict=True):
        what = f"Kernels, {book.kind} speed: against their plain text"
        if not (book.content and other.content):
            yield not_checked(what, how, f"a tune failed: plain, {other.ran.sentence}", limit)
            continue
        names = sorted(book.content.keys() | other.content.keys())
        unlike = [name for name in names if book.content.get(name) != other.content.get(name)]
        told = f"other bytes: {', '.join(unlike)}" if unlike else "all equal"
        yield checked(what, how, f"{len(names)} files; {told}", limit, not unlike)


ELSEWHERE: Final = 0.01
"""Relative difference of an rms where the kept books were not made: another kind of processor, other libraries.

Sums end there in other last bits, so a search for the best lines ends beside where it ended elsewhere.
"""

LIBRARIES: Final = ("llvmlite", "numba", "numpy", "scipy")
"""Those whose versions decide the last bits of a number."""

FUSED: Final = "X86_V3"
"""numpy's name of processors with AVX2 and fused multiply-adds: without these numba and OpenBLAS round elsewhere."""

FIGURES: Final = {"predicted": "predicted rms", "validated": "simulated rms"}


@dataclass(frozen=True)
class Golden:
    """A book as it was kept: SHA-256 of its tables by kind of processor, and rms in m/s of its table by member.

    `made_with` is what `surroundings` gave there: with the same the bytes must be the kept ones.
    """

    sha256: Mapping[str, str]
    rms_m_s: Mapping[str, float]
    made_with: Mapping[str, str]


def kept() -> dict[str, Golden]:
    """The books by kind."""
    document: dict[str, Any] = json.loads((files("synth.cli.qualification") / "golden.json").read_bytes())
    return {kind: Golden(**entry, made_with=document["made_with"]) for kind, entry in document["books"].items()}


def golden_of(book: Tuned) -> Golden:
    """What is to be kept of a book on this kind of processor, whose name is not known here: ""."""
    return Golden({"": book.sha256}, {key: book.document[key]["rms_m_s"] for key in FIGURES}, surroundings())


def surroundings() -> dict[str, str]:
    """What decides the last bits here: system, versions of libraries, and extensions of the processor but AVX-512."""
    extensions = np.show_config(mode="dicts")["SIMD Extensions"]
    return {
        "system": f"{platform.system()} {platform.machine()}",
        "C library": " ".join(platform.libc_ver()),
        "processor": FUSED if FUSED in (*extensions["baseline"], *extensions["found"]) else "another",
        **{name: version(name) for name in LIBRARIES},
    }


def golden_checks(books: Sequence[Tuned]) -> Iterator[Check]:
    """Whether each book is the kept one."""
    golden = kept()
    for book in books:
        if book.tables:
            yield golden_check(book, golden[book.kind])


def golden_check(book: Tuned, golden: Golden) -> Check:
    """By its bytes; where it was made with something else than the kept ones, and has others, by its figures."""
    what = f"Tune, {book.kind} speed: golden bytes"
    how = "SHA-256 of the tables of a small problem against those kept in the program"
    kinds = [kind for kind, sha256 in golden.sha256.items() if sha256 == book.sha256]
    if kinds:
        return checked(what, how, f"the bytes of processors {' and '.join(kinds)}", "equal", True)
    found = golden_of(book)
    said = f"other bytes ({book.sha256[:16]}…) than on processors {' or '.join(golden.sha256)}"
    others = [name for name, value in found.made_with.items() if value != golden.made_with[name]]
    if not others:
        return checked(what, how, f"{said}, with the same system and libraries", "equal", False)
    pairs = {FIGURES[key]: (found.rms_m_s[key], golden.rms_m_s[key]) for key in FIGURES}
    told = "; ".join(f"{name} {own:.4f} m/s, {due:.4f} kept" for name, (own, due) in pairs.items())
    off = max(abs(own / due - 1.0) for own, due in pairs.values())
    limit = f"equal; where {', '.join(others)} differ from those there, each rms within {100 * ELSEWHERE:g} %"
    return checked(what, how, f"{said}: {told}", limit, off <= ELSEWHERE)
