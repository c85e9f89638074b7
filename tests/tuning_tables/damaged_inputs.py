"""Inputs for the readers that are nearly tables: a stream of them from one generator of random numbers.

The kinds go deeper and deeper. Changed bytes and tokens meet the parser and the checksum; a document or book whose
sums were made right again meets the checks behind them.
"""

from __future__ import annotations

import copy
import json
import random
import re
import struct
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from tests.tuning_tables.forged_book import forge, put
from tuning_tables import ControllerTable, to_json, write_book
from tuning_tables.book_layout import stored_layout
from tuning_tables.canonical import canonical_json, document_checksum

TOKEN = re.compile(rb'"(?:[^"\\]|\\.)*"|[-+0-9.eE]+|[a-z]+|\s+|.', re.DOTALL)
TOKENS = (
    b"{",
    b"}",
    b"[",
    b"]",
    b",",
    b":",
    b"null",
    b"true",
    b"NaN",
    b"1e999",
    b"-0.0",
    b"0",
    b'""',
    b'"\\ud800"',
    b" ",
)
TEXTS = ("", "x", "\n", "\0", "\ud800", "Л", "\U0001f600", "x" * 5000, "s_m", "1", "2026-01-01T00:00:00Z", "0" * 64)
NUMBERS = (0, 1, -1, 2, 31, 32, 33, 2**31, 2**53, 2**53 + 1, 10**21, 0.0, -0.0, 0.5, 1e-45, 5e-324, 1e6, 3.4e38, 1e308)


@dataclass(frozen=True)
class Attempt:
    """Something to read: `content` for the reader named by `reader`, "json" or "book"; `kind` tells how it was made."""

    kind: str
    reader: str
    content: bytes


def attempts(seed: int, tables: list[ControllerTable], folder: Path, books: float = 0.1) -> Iterator[Attempt]:
    """Damaged forms of `tables` without end; one of `1 / books` is a book. `folder`: where books may be made."""
    rng = random.Random(seed)
    texts = [to_json(table) for table in tables]
    texts += [canonical_json(json.loads(text)) for text in texts]
    write_book(tables, folder / "original.h5", tables[0].generator)
    book = (folder / "original.h5").read_bytes()
    while True:
        if rng.random() < books:
            yield _forged_book(rng, book, folder) if rng.random() < 0.8 else _changed("book", rng, book)
        else:
            make = rng.choice((_changed_text, _exchanged_tokens, _spliced, _altered, _altered, _altered, _invented))
            yield make(rng, texts)


def _changed_text(rng: random.Random, texts: list[bytes]) -> Attempt:
    return _changed("json", rng, rng.choice(texts))


def _changed(reader: str, rng: random.Random, content: bytes) -> Attempt:
    """A few bytes replaced, removed, inserted, doubled; or the end cut off."""
    changed = bytearray(content)
    for _ in range(rng.choice((1, 1, 1, 2, 5, 50))):
        begin = rng.randrange(len(changed) + 1)
        end = min(len(changed), begin + rng.choice((0, 1, 1, 2, 8, 200)))
        piece = rng.choice((b"", rng.randbytes(1), rng.randbytes(end - begin), bytes(changed[begin:end]) * 2))
        changed[begin:end] = piece
    if rng.random() < 0.1:
        del changed[rng.randrange(len(changed) + 1) :]
    return Attempt("bytes", reader, bytes(changed))


def _exchanged_tokens(rng: random.Random, texts: list[bytes]) -> Attempt:
    tokens = TOKEN.findall(rng.choice(texts))
    for _ in range(rng.choice((1, 1, 2, 5))):
        place = rng.randrange(len(tokens))
        tokens[place] = rng.choice((rng.choice(TOKENS), rng.choice(tokens), b"", tokens[place] * 2))
    return Attempt("tokens", "json", b"".join(tokens))


def _spliced(rng: random.Random, texts: list[bytes]) -> Attempt:
    """The beginning of one text and the end of another, cut between tokens."""
    first, second = (TOKEN.findall(rng.choice(texts)) for _ in range(2))
    begin = rng.randrange(len(first))
    end = min(len(second), max(0, begin + rng.choice((-2, -1, 0, 1, 2, 10))))
    return Attempt("splice", "json", b"".join(first[:begin] + second[end:]))


def _altered(rng: random.Random, texts: list[bytes]) -> Attempt:
    """The document of a table with some members changed, and the checksum that is right for it."""
    document = json.loads(rng.choice(texts))
    for _ in range(rng.choice((1, 1, 1, 2, 4))):
        _alter(rng, document)
    return Attempt("altered", "json", _sealed(rng, document))


def _invented(rng: random.Random, texts: list[bytes]) -> Attempt:
    """A document with the right keys, or nearly, of random values."""
    like = json.loads(rng.choice(texts))
    document = {key: value if rng.random() < 0.7 else _value(rng, 3) for key, value in like.items()}
    return Attempt("invented", "json", _sealed(rng, document if rng.random() < 0.9 else {"format": _value(rng, 4)}))


def _sealed(rng: random.Random, document: dict[str, Any]) -> bytes:
    try:
        document = {**document, "crc32": document_checksum(document)}
        return canonical_json(document) if rng.random() < 0.8 else json.dumps(document).encode("utf-8")
    except ValueError:  # not canonical, so without a right checksum
        return json.dumps(document).encode("utf-8")


def _alter(rng: random.Random, document: dict[str, Any]) -> None:
    """Change one member, somewhere, of an object or an array."""
    places = list(_places(document))
    parent, key = rng.choice(places)
    fate = rng.random()
    if fate < 0.1:
        del parent[key]
    elif fate < 0.2 and isinstance(parent, list):
        parent.insert(key, copy.deepcopy(parent[key]))
    elif fate < 0.2:
        parent[rng.choice((*TEXTS, "lower", "k", "s_m"))] = parent[key]
    elif fate < 0.4:
        other, at = rng.choice(places)
        if at in other if isinstance(other, dict) else at < len(other):
            parent[key] = copy.deepcopy(other[at])
    elif fate < 0.8 and isinstance(parent[key], int | float):
        parent[key] = rng.choice((_float(rng), parent[key] * rng.uniform(0.5, 1.5), -parent[key], int(parent[key])))
    else:
        parent[key] = _value(rng, 2)


def _places(value: Any) -> Iterator[tuple[Any, Any]]:
    members = value.items() if isinstance(value, dict) else enumerate(value) if isinstance(value, list) else ()
    for key, member in members:
        yield value, key
        yield from _places(member)


def _value(rng: random.Random, depth: int) -> Any:
    makers: list[Callable[[], Any]] = [
        lambda: rng.choice((None, True, False)),
        lambda: rng.choice(NUMBERS),
        lambda: rng.choice(TEXTS),
        lambda: _float(rng),
        lambda: [_float(rng) for _ in range(rng.randrange(12))],
    ]
    if depth > 0:
        makers.append(lambda: [_value(rng, depth - 1) for _ in range(rng.randrange(5))])
        makers.append(lambda: {rng.choice(TEXTS): _value(rng, depth - 1) for _ in range(rng.randrange(5))})
    return rng.choice(makers)()


def _float(rng: random.Random) -> float:
    """A finite double or float32 number, of any size."""
    code, size = rng.choice((("<d", 8), ("<f", 4), ("<f", 4)))
    (value,) = struct.unpack(code, rng.randbytes(size))
    return value if np.isfinite(value) else rng.uniform(-10.0, 10.0)


def _forged_book(rng: random.Random, book: bytes, folder: Path) -> Attempt:
    """A book with some values, types or lengths changed, and the checksums and the seal that are right for it."""
    path = folder / "forged.h5"
    path.write_bytes(book)

    def edit(file: Any) -> None:
        columns = stored_layout(str(file.attrs["kind"]), set(file)).columns
        for column in rng.sample(columns, rng.choice((1, 1, 2, 4))):
            values = file[column.name][()]
            if rng.random() < 0.8:
                index = tuple(rng.randrange(length) for length in values.shape)
                file[column.name][index] = _entry(rng, values, index)
            else:
                put(file, column.name, _reshaped(rng, values))

    forge(path, edit)
    return Attempt("forged", "book", path.read_bytes())


def _entry(rng: random.Random, values: np.ndarray, index: tuple[int, ...]) -> Any:
    if values.dtype.kind == "S":
        text = rng.choice((*TEXTS, values[index].decode())).encode("utf-8", "surrogatepass")
        return text[: values.dtype.itemsize]
    if values.dtype.kind == "f":
        changed = rng.choice((np.nan, np.inf, -0.0, 0.0, _float(rng), float(values[index]) * rng.uniform(0.5, 1.5)))
        with np.errstate(all="ignore"):
            return values.dtype.type(changed)
    return rng.randrange(2 ** (8 * values.dtype.itemsize - 1)) if rng.random() < 0.3 else rng.randrange(5)


def _reshaped(rng: random.Random, values: np.ndarray) -> np.ndarray:
    axis = rng.randrange(values.ndim)
    if rng.random() < 0.3 and values.dtype.kind != "S":
        with np.errstate(all="ignore"):
            return values.astype(rng.choice(("<f4", ">f8", "<i8", "|u1")))
    places = range(values.shape[axis])
    return np.take(values, rng.choice(([*places, 0], [*places][1:], [*places][::-1], [])), axis=axis)
