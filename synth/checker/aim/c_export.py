"""The C99 export of aim tables against the tables: every word of the initialisers."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from typing import Final

from synth.checker.aim.reading import Aim
from synth.checker.canonical import crc32
from synth.checker.category_number import YARD
from synth.checker.code_records import words_of_array
from synth.checker.finding import DamagedError
from synth.checker.float32 import FLOAT, WORD, bits
from synth.checker.line_export import ascii_comment

Words = tuple[int, ...]

ARRAY: Final = re.compile(r"const aim_table aim_tables\[\w*\]\s*=\s*(\{.*?\})\s*;", re.DOTALL)
COUNT: Final = re.compile(r"const unsigned aim_table_count\s*=\s*(\d{1,6})u\s*;")
CATEGORY: Final = re.compile(r"#define AIM_CATEGORY_(\w+) (\d{1,6})u /\* (.*?) \*/")
SIZE: Final = "#define AIM_{} (\\d{{1,6}})u"


def read_blocks(source: str) -> list[Words]:
    """The words of each table in `aim_table.c`; `DamagedError` where the array is not as documented."""
    array, count = ARRAY.search(source), COUNT.search(source)
    if array is None or count is None:
        raise DamagedError("it has no array aim_tables or no aim_table_count")
    blocks = words_of_array(array[1])
    if len(blocks) != int(count[1]):
        raise DamagedError(f"aim_table_count is {count[1]}, but the array holds {len(blocks)} tables")
    return blocks


def differences(blocks: Sequence[Words], aims: Sequence[Aim], header: str) -> Iterator[tuple[str, str]]:
    """(about, sentence) for each disagreement; the order of the tables is told by category and kind."""
    told = [re.search(SIZE.format(name), header) for name in ("CARS", "DISTANCES", "RESISTANCES")]
    found = tuple(int(each[1]) if each else 0 for each in told)
    size = (
        max(len(aim.cars) for aim in aims),
        max(len(aim.distances_m) for aim in aims),
        max(max(1, len(aim.resistances)) for aim in aims),
    )
    if found != size:
        yield "", f"its header has room for {found} cars, distances and resistances, but the tables have {size}"
        return
    yield from (("", sentence) for sentence in category_differences(aims, header))
    by_place = {(block[0], block[3] > 0): (number, block) for number, block in enumerate(blocks) if len(block) > 8}
    if len(blocks) != len(aims) or len(by_place) != len(blocks):
        yield "", f"it holds {len(blocks)} tables, {len(by_place)} of them different, but there are {len(aims)}"
    for aim in aims:
        if (aim.category, aim.is_measured) not in by_place:
            yield aim.id, "it is not among the tables of the export"
            continue
        number, block = by_place[aim.category, aim.is_measured]
        body = b"".join(WORD.pack(word) for word in block[:-1])
        if block[-1] != crc32(body):
            yield aim.id, f"the crc32 of table {number} is {block[-1]:08x}, but its words give {crc32(body):08x}"
        wanted = words_of(aim, size)
        if block[:-1] != wanted:
            yield aim.id, word_difference(number, block[:-1], wanted)


def category_differences(aims: Sequence[Aim], header: str) -> Iterator[str]:
    """What is wrong with the constants of the weight categories: those of the yard are always there."""
    found = [(number, comment) for _, number, comment in CATEGORY.findall(header)]
    numbers = YARD | {aim.category_name: aim.category for aim in aims}
    wanted = [(str(number), ascii_comment(name)) for name, number in sorted(numbers.items(), key=lambda each: each[1])]
    if found != wanted:
        yield f"its header defines the categories {found}, but the tables have {wanted}"


def words_of(aim: Aim, size: tuple[int, int, int]) -> Words:
    """The words that a table should have, its checksum left out; what it has not is 0, no answer -1."""
    cars, distances, resistances = size
    words = [aim.category, len(aim.cars), len(aim.distances_m), len(aim.resistances)]
    words += [bits(x) for x in (aim.p_overspeed, aim.coupling_m_s, *aim.bounds_m_s)]
    words += padded(list(aim.cars), cars)
    words += padded([bits(x) for x in aim.distances_m], distances)
    words += padded([bits(x) for x in aim.resistances], resistances)
    for c in range(cars):
        for d in range(distances):
            inside = c < len(aim.cars) and d < len(aim.distances_m)
            row = aim.speeds[c][d] if inside else ()
            words += padded([bits(-1.0 if x is None else x) for x in row], resistances)
    return tuple(words)


def padded(words: list[int], length: int) -> list[int]:
    """`words` with zeros behind them."""
    return words + [0] * (length - len(words))


def word_difference(number: int, block: Words, wanted: Words) -> str:
    """The first word in which two blocks differ."""
    if len(block) != len(wanted):
        return f"table {number} has {len(block)} words, but {len(wanted)} are due"
    at = next(i for i, (a, b) in enumerate(zip(block, wanted, strict=True)) if a != b)
    values = [FLOAT.unpack(WORD.pack(words[at]))[0] for words in (block, wanted)]
    return (
        f"word {at} of table {number} is {block[at]:08x} ({values[0]:.9g}), "
        f"but the table says {wanted[at]:08x} ({values[1]:.9g})"
    )
