"""How much memory the control computer needs: a table of what is stored, with counts and bits."""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum

from plant_models.errors import require


class Memory(Enum):
    """Where something is kept."""

    FIXED = "read-only"
    WORKING = "read and written"


@dataclass(frozen=True)
class Stored:
    """`count` entries of `bits` each, kept in `memory`; where from, in words. Raises `PlantError`."""

    name: str
    count: int
    bits: int
    memory: Memory
    source: str

    def __post_init__(self) -> None:
        for name, value, least in (("count", self.count, 0), ("bits", self.bits, 1)):
            require(
                isinstance(value, int) and value >= least,
                f"{self.name}: {name} is {value!r}; it must be a whole number from {least} on",
            )

    def words(self, word_bits: int) -> int:
        """Words of `word_bits` that it takes; every entry begins with a new word."""
        require(
            isinstance(word_bits, int) and word_bits >= 1,
            f"word_bits is {word_bits!r}; it must be a whole number from 1 on",
        )
        return self.count * -(-self.bits // word_bits)

    @property
    def total_bits(self) -> int:
        """Without gaps."""
        return self.count * self.bits


@dataclass(frozen=True)
class MemoryTable:
    """What is stored, in the order of the table."""

    rows: tuple[Stored, ...]

    def words(self, memory: Memory, word_bits: int) -> int:
        """Words of `word_bits` in `memory`."""
        return sum(row.words(word_bits) for row in self.rows if row.memory is memory)

    def kibibytes(self, memory: Memory) -> float:
        """Of 1024 bytes, in `memory`, without gaps."""
        return sum(row.total_bits for row in self.rows if row.memory is memory) / 8192.0


def source_memory() -> MemoryTable:
    """The table of [hump-computer-1970s], chapter 3, for a hump of 141 objects (twice as many working cells).

    The bits of the initial data cannot be read in the copy ("~J"). They are records of cuts, which the same source
    makes 53 bits long, the width of the row below; so 53 is assumed. It asks for 2 000 words of either memory in the
    end: 1 800 words of 17 bits, and 1 438 words by number, which are 3 052 of 16 bits.
    """
    source = "[hump-computer-1970s], chapter 3, table 1"
    return MemoryTable(
        (
            Stored("programs", 1400, 17, Memory.FIXED, source),
            Stored("constants", 400, 16, Memory.FIXED, source),
            Stored("initial data", 256, 53, Memory.WORKING, f"{source}; bits not readable, 53 assumed"),
            Stored("working cells of programs", 900, 16, Memory.WORKING, source),
            Stored("working cells of objects", 282, 53, Memory.WORKING, source),
        )
    )


@dataclass(frozen=True)
class ControllerCounts:
    """What our controller holds: positions and their tables, switches, tracks, cuts of a train; bytes as exported.

    By default a book has 15 tables with estimators, whose bytes the study controller-cost counts: code on a Cortex-M4
    at -Os, of a table, of an estimate. An aim table has 16 × 16 speeds in binary32, assumed.
    """

    positions: int
    books: int
    aim_tables: int
    switches: int
    tracks: int
    cuts: int
    tables_a_book: int = 15
    code_bytes: int = 3544
    table_bytes: int = 500
    aim_table_bytes: int = 1024
    estimate_bytes: int = 64
    record_bits: int = 53


def controller_memory(counts: ControllerCounts) -> MemoryTable:
    """The memory of our controller. `PlantError` if a count is below 0 or no whole number.

    The route table tells the position of each switch for each track; the route store, the track of each cut.
    """
    exported = "bytes of the export"
    return MemoryTable(
        (
            Stored("code of the rule", counts.code_bytes, 8, Memory.FIXED, exported),
            Stored("tables", counts.books * counts.tables_a_book, 8 * counts.table_bytes, Memory.FIXED, exported),
            Stored("aim tables", counts.aim_tables, 8 * counts.aim_table_bytes, Memory.FIXED, exported),
            Stored("route table", counts.switches * counts.tracks, 2, Memory.FIXED, "left, right or not on the route"),
            Stored("chosen table", counts.positions, 8 * counts.table_bytes, Memory.WORKING, "a copy a position"),
            Stored("estimates", counts.positions, 8 * counts.estimate_bytes, Memory.WORKING, exported),
            Stored("cut records", counts.cuts, counts.record_bits, Memory.WORKING, "synth.hump.control.record_word"),
            Stored("route store", counts.cuts, 8, Memory.WORKING, "a track number of at most 199 a cut"),
        )
    )
