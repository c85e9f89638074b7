"""How much memory the control computer needs: a table of what is stored, with counts and bits."""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum


class Memory(Enum):
    """Where something is kept."""

    FIXED = "read-only"
    WORKING = "read and written"


@dataclass(frozen=True)
class Stored:
    """`count` entries of `bits` each, kept in `memory`; where from, in words."""

    name: str
    count: int
    bits: int
    memory: Memory
    source: str

    def words(self, word_bits: int) -> int:
        """Words of `word_bits` that it takes; every entry begins with a new word."""
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
    """The memory of our controller.

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
