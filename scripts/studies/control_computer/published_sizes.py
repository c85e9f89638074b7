"""Word length, inputs and outputs, and memory of the published control computer, counted again."""

from __future__ import annotations

from dataclasses import dataclass

from plant_models.library.hump_entry import hump_names, load_hump
from scripts.studies.study import MarkdownTable, table
from synth.computer.sizing.counted_needs import (
    ChannelRules,
    Channels,
    ControllerCounts,
    Memory,
    MemoryTable,
    Quantity,
    Stored,
    common_word_bits,
    controller_memory,
    counted_channels,
    digits,
    hump_quantities,
    source_channels,
    total_channels,
)

SOURCE_WORD_BITS = 16
"""What [hump-computer-1970s] chooses."""

CUTS = 60
"""Of the longest train, assumed."""


@dataclass(frozen=True)
class QuantityBits:
    """Binary digits of one quantity, by ours and by the published formula."""

    name: str
    bits: int
    published_formula: int


@dataclass(frozen=True)
class HumpChannels:
    """Tracks, positions and channels of a hump; `hump` '' for what is published."""

    hump: str
    tracks: int
    positions: int
    digital_in: int
    analog_in: int
    digital_out: int
    analog_out: int


@dataclass(frozen=True)
class MemoryRow:
    """What one thing takes, in words and bits of a word."""

    what: str
    memory: str
    count: int
    bits: int


@dataclass(frozen=True)
class PublishedSizes:
    """All of them. `fixed_words`, `working_words`: of the published table."""

    quantities: tuple[QuantityBits, ...]
    word_bits: int
    channels: tuple[HumpChannels, ...]
    published_memory: tuple[MemoryRow, ...]
    fixed_words: int
    working_words: int
    our_memory: tuple[MemoryRow, ...]

    def tables(self) -> dict[str, MarkdownTable]:
        """`bits`, `channels`, `memory`."""
        return {
            "bits": table(
                f"binary digits of what the computer handles; {SOURCE_WORD_BITS} are published",
                ("quantity", "digits", "by the published formula"),
                ((q.name, str(q.bits), str(q.published_formula)) for q in self.quantities),
            ),
            "channels": table(
                "inputs and outputs",
                ("hump", "tracks", "positions", "digital in", "analog in", "digital out", "analog out"),
                ((c.hump or "published", *(str(n) if n else "–" for n in (c.tracks, c.positions)),
                  *map(str, (c.digital_in, c.analog_in, c.digital_out, c.analog_out))) for c in self.channels),
            ),
            "memory": table(
                "what is kept in memory: the published table, and our controller on the large hump",
                ("of", "what", "memory", "entries", "bits each"),
                ((of, m.what, m.memory, str(m.count), str(m.bits))
                 for of, rows in (("published", self.published_memory), ("ours", self.our_memory)) for m in rows),
            ),
        }  # fmt: skip


def published_sizes() -> PublishedSizes:
    """All parts."""
    published, ours = source_memory(), our_memory("large")
    return PublishedSizes(
        quantities=tuple(QuantityBits(q.name, q.bits, bits_of_source(q)) for q in hump_quantities()),
        word_bits=common_word_bits(hump_quantities()),
        channels=(hump_channels("", 0, 0, source_channels()), *map(channels_of, hump_names())),
        published_memory=memory_rows(published),
        fixed_words=published.words(Memory.FIXED, 17),
        working_words=published.words(Memory.WORKING, 53),
        our_memory=memory_rows(ours),
    )


def bits_of_source(quantity: Quantity) -> int:
    """R = log2((greatest − least + 1)/step), rounded up, as [hump-computer-1970s] prints it.

    The 1 is one unit there, not one step, so the result depends on the unit. For a range of whole steps it is never
    too few; for steps below 1 it can be more than is needed, most where the range is small.
    """
    return max(1, digits((quantity.greatest - quantity.least + 1.0) / quantity.step))


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


def channels_of(name: str) -> HumpChannels:
    """Of a hump of the library."""
    graph = load_hump(name).graph
    total = total_channels(counted_channels(graph, ChannelRules()))
    return hump_channels(name, len(graph.tracks), len(graph.retarders), total)


def hump_channels(name: str, tracks: int, positions: int, found: Channels) -> HumpChannels:
    """As plain numbers."""
    return HumpChannels(name, tracks, positions, found.digital_in, found.analog_in, found.digital_out, found.analog_out)


def our_memory(name: str) -> MemoryTable:
    """Of our controller on a hump of the library."""
    graph = load_hump(name).graph
    return controller_memory(
        ControllerCounts(
            positions=len(graph.retarders), books=2, aim_tables=6,
            switches=len(graph.switches), tracks=len(graph.tracks), cuts=CUTS,
        )
    )  # fmt: skip


def memory_rows(found: MemoryTable) -> tuple[MemoryRow, ...]:
    """As plain values."""
    return tuple(MemoryRow(row.name, row.memory.value, row.count, row.bits) for row in found.rows)
