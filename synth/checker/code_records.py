"""Records in exported code, read without the program that wrote it: of each table the numbers by member.

C: members from the struct of the header, numbers from the initialisers. Structured Text: members from the TYPE; numbers
from constant arrays, those of all tables in `MemberOf`; arrays of one table in `Member_k`, k from `PartPart`, and where
they are long in `Member_k_1` and on.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from math import prod
from typing import Final, NamedTuple

from synth.checker.content import crc32
from synth.checker.finding import DamagedError, shown
from synth.checker.float32 import WORD, bits, from_bits, is_float32, rounded

Numbers = Mapping[str, Sequence[float]]
"""By member the numbers of a table, arrays flat; names in small letters without "_"."""

TOKEN: Final = re.compile(
    r"\s+|/\*.*?\*/|(?P<mark>[{},])|(?P<real>-?0x[01](?:\.[0-9a-f]{1,6})?p[+-]\d{1,3}f)"
    r"|(?P<whole>(?:0x[0-9a-f]{1,8}u|-?\d{1,10}u?))",
    re.DOTALL,
)
C_MEMBER: Final = re.compile(r"^\s*(int32_t|float|uint32_t) (\w+)((?:\[\d+\])*);", re.MULTILINE)
ST_MEMBER: Final = re.compile(r"^\s*(\w+) : (?:ARRAY\[0\.\.(\d{1,6})\] OF )?(REAL|INT);", re.MULTILINE)
ST_ARRAY: Final = re.compile(r"\b(\w+) : ARRAY\[0\.\.(\d{1,6})\] OF (REAL|INT) := \[([^\]]*)\];")
ST_COMMENT: Final = re.compile(r"\(\*.*?\*\)", re.DOTALL)
C_COMMENT: Final = re.compile(r"/\*.*?\*/", re.DOTALL)


@dataclass(frozen=True)
class Member:
    """A member of a record: its name as in `Numbers`, whether it is binary32, how many numbers it has."""

    name: str
    is_real: bool
    length: int


def plain(name: str) -> str:
    """A name as in `Numbers`."""
    return name.replace("_", "").lower()


def c_members(header: str, record: str) -> list[Member]:
    """The members of a struct, its checksum left out."""
    found = re.search(rf"typedef struct {record} \{{(.*?)\}} {record};", C_COMMENT.sub(" ", header), re.DOTALL)
    if found is None:
        raise DamagedError(f"its header has no struct {record}")
    members = []
    for kind, name, axes in C_MEMBER.findall(found[1]):
        length = prod(int(each) for each in re.findall(r"\d+", axes))
        members.append(Member(plain(name), kind == "float", length))
    if not members or members[-1].name != "crc32":
        raise DamagedError(f"the struct {record} does not end with its checksum")
    return members[:-1]


def c_records(source: str, members: Sequence[Member], array: str, count: str) -> list[tuple[int, ...]]:
    """The words of each table, its checksum last; `DamagedError` where the array is not as documented."""
    found = re.search(rf"const \w+ {array}\[\w*\]\s*=\s*(\{{.*?\}})\s*;", source, re.DOTALL)
    told = re.search(rf"const int32_t {count}\s*=\s*(\d{{1,6}})\s*;", source)
    if found is None or told is None:
        raise DamagedError(f"it has no array {array} or no {count}")
    blocks = words_of_array(found[1])
    if len(blocks) != int(told[1]):
        raise DamagedError(f"{count} is {told[1]}, but the array holds {len(blocks)} tables")
    due = 1 + sum(member.length for member in members)
    for number, block in enumerate(blocks):
        if len(block) != due:
            raise DamagedError(f"table {number} has {len(block)} words, but its struct has {due}")
    return blocks


def words_of_array(text: str) -> list[tuple[int, ...]]:
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
    try:
        number = int(str(whole).rstrip("u"), 0)
    except ValueError:  # a 0 before other digits
        raise DamagedError(f"{whole} is no whole number") from None
    if not -(2**31) <= number < 2**32:
        raise DamagedError(f"{whole} does not fit into 32 bits")
    return number % 2**32


def c_numbers(members: Sequence[Member], words: Sequence[int]) -> Numbers:
    """The numbers of a table from its words."""
    found, place = {}, 0
    for member in members:
        part = words[place : place + member.length]
        found[member.name] = [from_bits(word) if member.is_real else signed(word) for word in part]
        place += member.length
    return found


def signed(word: int) -> int:
    """A word as a number of either sign."""
    return word - 2**32 if word >= 2**31 else word


def checksum_fault(number: int, words: Sequence[int]) -> str | None:
    """What is wrong with the checksum of table `number`, None if nothing is."""
    due = crc32(b"".join(WORD.pack(word) for word in words[:-1]))
    return None if words[-1] == due else f"the crc32 of table {number} is {words[-1]:08x}, but its words give {due:08x}"


def st_members(text: str, record: str) -> list[Member]:
    """The members of a TYPE."""
    found = re.search(rf"\b{record} :\s*STRUCT(.*?)END_STRUCT", ST_COMMENT.sub(" ", text), re.DOTALL)
    if found is None:
        raise DamagedError(f"it has no type {record}")
    return [Member(plain(name), kind == "REAL", int(last or 0) + 1) for name, last, kind in ST_MEMBER.findall(found[1])]


def st_arrays(text: str) -> dict[str, list[list[float]]]:
    """All constant arrays by name, each as often as it is declared; `DamagedError` for one that cannot be read."""
    found: dict[str, list[list[float]]] = {}
    for name, last, kind, content in ST_ARRAY.findall(ST_COMMENT.sub(" ", text)):
        try:
            values = [int(each) if kind == "INT" else rounded(float(each)) for each in content.split(",")]
        except ValueError:
            raise DamagedError(f"the array {name} holds something else than {kind}") from None
        if len(values) != int(last) + 1:
            raise DamagedError(f"the array {name} holds {len(values)} values, but is declared with {int(last) + 1}")
        found.setdefault(name, []).append(values)
    return found


class StRecords(NamedTuple):
    """The tables of an export in Structured Text: members, and for each table its numbers, where they can be found."""

    members: Sequence[Member]
    tables: Sequence[Numbers]
    faults: Sequence[str]


def st_records(text: str, record: str, load: str) -> StRecords:
    """The tables of the block `load`, and columns of other blocks that differ from it."""
    members, arrays = st_members(text, record), st_arrays(text)
    block = re.search(rf"FUNCTION_BLOCK {load}\n(.*?)END_FUNCTION_BLOCK", text, re.DOTALL)
    if block is None:
        raise DamagedError(f"it has no block {load}")
    own = st_arrays(block[1])
    columns = {plain(name.removesuffix("Of")): rows[0] for name, rows in own.items() if name.endswith("Of")}
    parts = {
        name.removesuffix("Part"): [int(each) for each in rows[0]]
        for name, rows in own.items()
        if name.endswith("Part")
    }
    count = max((len(column) for column in columns.values()), default=0)
    tables: list[dict[str, Sequence[float]]] = [{} for _ in range(count)]
    faults = [f"{name} stands there more than once, and differs" for name, rows in arrays.items()
              if name.endswith("Of") and any(row != rows[0] for row in rows)]  # fmt: skip
    numbered = {name.rpartition("_")[0]: name for name in own if name.rpartition("_")[2].isdigit()}
    part_of = {stem: part_named(block[1], stem) for stem in numbered}
    for number in range(count):
        for member in members:
            stem = None if member.name in columns else next((x for x in numbered if is_short(member.name, x)), None)
            if stem is None:
                short = next((columns[each] for each in columns if is_short(member.name, each)), None)
                column = columns.get(member.name, short)
                if column is not None and number < len(column):
                    tables[number][member.name] = [column[number]]
                continue
            part = parts.get(part_of[stem], [])
            name = f"{stem}_{part[number]}" if number < len(part) else ""
            if name in own:
                tables[number][member.name] = [*own[name][0], *further(own, name)]
    return StRecords(members, tables, faults)


def further(arrays: Mapping[str, list[list[float]]], name: str) -> Iterator[float]:
    """What goes on in arrays of their own, `Member_k_1`, `Member_k_2`: a constant array has a greatest length."""
    piece = 1
    while f"{name}_{piece}" in arrays:
        yield from arrays[f"{name}_{piece}"][0]
        piece += 1


def part_named(block: str, stem: str) -> str:
    """Which part tells the number of the arrays that begin with `stem`."""
    before = block.partition(f"{stem}_0[Index]")[0]
    found = re.findall(r"CASE (\w+)Part\[TableNo\] OF", before)
    return found[-1] if found else ""


def is_short(member: str, stem: str) -> bool:
    """Whether an array is of a member: its name is that of the member, or that without its unit."""
    short = plain(stem)
    return member == short or (member.startswith(short) and member.removeprefix(short) in UNITS)


UNITS: Final = ("", "m", "ms", "ms2", "kpa", "t", "s", "m2s2", "mskpa", "nperkn")


def differences(number: int, found: Numbers, due: Numbers) -> Iterator[str]:
    """What is wrong with table `number`: a sentence for each member that is missing, too many, or another."""
    for name in due.keys() - found.keys():
        yield f"{name} of table {number} is missing"
    for name in found.keys() - due.keys():
        yield f"{name} of table {number} stands there, but the tables have none"
    for name in (each for each in due if each in found):
        have, wanted = list(found[name]), [rounded(each) for each in due[name]]
        if len(have) != len(wanted):
            yield f"{name} of table {number} has {len(have)} numbers, but {len(wanted)} are due"
        elif have != wanted:
            at = next(place for place, pair in enumerate(zip(have, wanted, strict=True)) if pair[0] != pair[1])
            place = f"[{at}]" if len(wanted) > 1 else ""
            yield f"{name}{place} of table {number} is {shown(have[at])}, but the table says {shown(wanted[at])}"
