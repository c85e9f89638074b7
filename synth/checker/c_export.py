"""The C99 export against the tables: the initialisers of `retarder_tables` read by a parser of their own."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from typing import Final

from synth.checker.canonical import crc32
from synth.checker.category_number import YARD
from synth.checker.estimator import Estimator, Held
from synth.checker.finding import DamagedError
from synth.checker.float32 import FLOAT, WORD, bits, is_float32
from synth.checker.table_reading import Table

TOKEN: Final = re.compile(
    r"\s+|/\*.*?\*/|(?P<mark>[{},])|(?P<real>-?0x[01](?:\.[0-9a-f]{1,6})?p[+-]\d{1,3}f)"
    r"|(?P<whole>(?:0x[0-9a-f]{1,8}|\d{1,10})u)",
    re.DOTALL,
)
ARRAY: Final = re.compile(r"const retarder_table retarder_tables\[\w*\]\s*=\s*(\{.*?\})\s*;", re.DOTALL)
COUNT: Final = re.compile(r"const unsigned retarder_table_count\s*=\s*(\d{1,6})u\s*;")
CATEGORY: Final = re.compile(r"#define RETARDER_CATEGORY_(\w+) (\d{1,6})u /\* (.*?) \*/")
LAYOUT: Final = r"#define RETARDER_LAYOUT (\d{1,6})u"
SIZE: Final = "#define RETARDER_{} (\\d{{1,6}})u"

Words = tuple[int, ...]


def read_blocks(source: str) -> list[Words]:
    """The words of each table in `retarder_table.c`; `DamagedError` where the array is not as documented."""
    array, count = ARRAY.search(source), COUNT.search(source)
    if array is None or count is None:
        raise DamagedError("it has no array retarder_tables or no retarder_table_count")
    blocks = words_of_array(array[1])
    if len(blocks) != int(count[1]):
        raise DamagedError(f"retarder_table_count is {count[1]}, but the array holds {len(blocks)} tables")
    return blocks


def words_of_array(text: str) -> list[Words]:
    """The words of each element of an array of tables; `DamagedError` for anything but numbers in balanced braces."""
    blocks: list[list[int]] = []
    depth = place = 0
    while place < len(text):
        token = TOKEN.match(text, place)
        if token is None:
            raise DamagedError(f"{text[place : place + 30]!r} is no number of a table")
        place = token.end()
        if token["mark"] == "{":
            depth += 1
            if depth == 2:
                blocks.append([])
        elif token["mark"] == "}":
            depth -= 1
        elif token["real"] or token["whole"]:
            if depth < 2:
                raise DamagedError("a number stands outside the tables")
            blocks[-1].append(word_of(token["real"], token["whole"]))
    if depth != 0:
        raise DamagedError("the braces of its tables do not match")
    return [tuple(block) for block in blocks]


def word_of(real: str | None, whole: str | None) -> int:
    """The 32 bits of a constant."""
    if real is not None:
        value = float.fromhex(real[:-1])
        if not is_float32(value):
            raise DamagedError(f"{real} is no float32 number")
        return bits(value)
    number = int(str(whole)[:-1], 0)
    if number >= 2**32:
        raise DamagedError(f"{whole} does not fit into 32 bits")
    return number


def differences(blocks: Sequence[Words], tables: Sequence[Table], header: str) -> Iterator[tuple[str, str]]:
    """(about, sentence) for each disagreement; `tables` in the order of the book, "" stands for the export."""
    if len(blocks) != len(tables):
        yield "", f"it holds {len(blocks)} tables, but there are {len(tables)}"
        return
    stages, powers = (re.search(SIZE.format(name), header) for name in ("STAGES", "POWERS"))
    if stages is None or powers is None:
        yield "", "its header does not tell RETARDER_STAGES and RETARDER_POWERS"
        return
    size = int(stages[1]), int(powers[1]), most_breaks(tables), any(table.approach_m > 0.0 for table in tables)
    any_time, gauge = any(table.at_any_time for table in tables), any(table.has_gauge for table in tables)
    yield from (("", sentence) for sentence in category_differences(tables, header))
    yield from (("", sentence) for sentence in room_differences(header, size[2], size[3], any_time, gauge))
    for number, (block, table) in enumerate(zip(blocks, tables, strict=True)):
        body = b"".join(WORD.pack(word) for word in block[:-1])
        if block[-1] != crc32(body):
            yield table.id, f"the crc32 of table {number} is {block[-1]:08x}, but its words give {crc32(body):08x}"
        wanted = words_of(table, size, any_time, gauge)
        if block[:-1] != wanted:
            yield table.id, word_difference(number, block[:-1], wanted)


def room_differences(header: str, breaks: int, approach: bool, any_time: bool, gauge: bool) -> Iterator[str]:
    """What the header has room for and no table has, or the other way round; where it names none, it has no room."""
    told = re.search(SIZE.format("BREAKS"), header)  # not in exports from before there were estimators
    if int(told[1] if told else 0) != breaks:
        yield f"its header has room for {told[1] if told else 'no'} breaks, but the tables have {breaks}"
    for macro, what, is_there, has in (
        ("APPROACH", "an approach", approach, "has one"),
        ("AT_ANY_TIME", "times of decision", any_time, "decides at any time"),
        ("GAUGE", "slopes", gauge, "has slopes"),
    ):
        told = re.search(SIZE.format(macro), header)
        if int(told[1] if told else 0) != is_there:
            yield f"its header has {'no ' * is_there}room for {what}, but {'a' if is_there else 'no'} table {has}"


def category_differences(tables: Sequence[Table], header: str) -> Iterator[str]:
    """What is wrong with the constants of the weight categories: those of the yard are always there."""
    found = [(number, comment) for _, number, comment in CATEGORY.findall(header)]
    numbers = YARD | {table.category: table.category_number or 0 for table in tables}
    by_number = sorted(numbers.items(), key=lambda each: each[1])
    wanted = [(str(number), ascii_comment(name)) for name, number in by_number]
    if found != wanted:
        yield f"its header defines the categories {found}, but the tables have {wanted}"
    if len({name for name, _, _ in CATEGORY.findall(header)}) < len(found):
        yield "its header gives two categories one name"


def ascii_comment(text: str) -> str:
    """A name as the export writes it into comments."""
    plain = "".join(x if x.isascii() and (x.isalnum() or x in " ._+,()-") else f"<U+{ord(x):04X}>" for x in text)
    return plain.replace("RETARDER_", "RETARDER<U+005F>").replace("retarder_", "retarder<U+005F>")


def most_breaks(tables: Sequence[Table]) -> int:
    """Breaks that each block of an export has room for: 0 if none of its tables has an estimator."""
    return max(len(table.estimator.s_m) if table.estimator else 0 for table in tables)


def words_of(table: Table, size: tuple[int, int, int, bool], any_time: bool = False, gauge: bool = False) -> Words:
    """The words that a table should have, its checksum left out; missing lines, stages, powers and breaks are 0.

    `size`: stages, powers, breaks, and whether there is room for an approach; its length is 0 for a table without.
    `any_time`, `gauge`: whether there is room for the times of decision, and for pressures and slopes; these are 0 for
    a table without slopes.
    """
    stages, powers, breaks, approach = size
    lines = [(lower is not None) + 2 * (upper is not None) for lower, upper in table.lines]
    words = [table.category_number or 0, len(table.axle_offsets_m), len(table.lines), table.degree + 1]
    words += lines + [0] * (stages - len(lines))
    words += [bits(x) for x in (table.mass_t, table.target_m_s, *table.path_m)]
    for k in range(stages):
        for line in table.lines[k] if k < len(table.lines) else (None, None):
            coefficients = line or ()
            words += [bits(c) for c in coefficients] + [0] * (powers - len(coefficients))
    words += estimator_words(table.estimator, breaks) if breaks else []
    words += [bits(table.approach_m), table.entrance_stage] if approach else []
    words += [int(table.at_any_time)] if any_time else []
    return tuple(words + (gauge_words(table, stages) if gauge else []))


def gauge_words(table: Table, stages: int) -> list[int]:
    """The pressure of the highest stage raised to, those of the stages, the slopes by stage and line."""
    if not table.has_gauge:
        return [0] * (1 + 3 * stages)
    none = [0] * (stages - len(table.lines))
    slopes = [bits(slope or 0.0) for both in table.slopes for slope in both]
    return [bits(table.pressures_kpa[table.top_stage]), *map(bits, table.pressures_kpa), *none, *slopes, *none, *none]


def estimator_words(estimator: Estimator | None, breaks: int) -> list[int]:
    """Number of breaks, the numbers of `Held`; then all s, all D, all W."""
    if estimator is None:
        return [0] * (1 + len(Held._fields) + 3 * breaks)
    numbers, *rows = estimator.held
    padded = [word for row in rows for word in [*map(bits, row), *[0] * (breaks - len(row))]]
    return [len(estimator.s_m), *map(bits, numbers), *padded]


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
