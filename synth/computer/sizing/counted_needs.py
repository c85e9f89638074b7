"""What a control computer needs beside speed, counted: binary digits of a quantity, memory by a table of what is
stored, inputs and outputs over the elements of a hump, by stated rules.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from enum import Enum

from plant_models.hump import HumpGraph


@dataclass(frozen=True)
class Quantity:
    """A quantity whose absolute value is from `least` to `greatest`, wanted in steps of `step`; all in one unit."""

    name: str
    least: float
    greatest: float
    step: float

    @property
    def bits(self) -> int:
        """Digits that tell all steps apart: the least R with 2^R ≥ (greatest − least)/step + 1, without a sign."""
        return max(1, digits((self.greatest - self.least) / self.step + 1.0))


def digits(values: float) -> int:
    """log2 rounded up; a ratio of decimals that should be a power of 2 must not be one digit more by its rounding."""
    return math.ceil(math.log2(values * (1.0 - 1e-12)))


def common_word_bits(quantities: tuple[Quantity, ...]) -> int:
    """Digits of the word that holds any of `quantities`."""
    return max(quantity.bits for quantity in quantities)


def hump_quantities() -> tuple[Quantity, ...]:
    """What the hump computer handles, in steps of sensors, of the cut record and of the sampling, as this program has.

    The widest take 14 digits; 16 is the next word that is built, and the choice of [hump-computer-1970s].
    """
    return (
        Quantity("measured speed, m/s: strobe, radar", 0.0, 8.5, 0.04),
        Quantity("commanded speed, m/s: strobe, a quarter of the radar's step", 0.0, 8.5, 0.01),
        Quantity("place, m: crest to end of track, 1 m/s for one sample", 0.0, 1500.0, 0.1),
        Quantity("mass of a cut, t: cut record", 0.0, 2046.0, 2.0),
        Quantity("pressure, kPa: supply, a tenth of the dead band", 0.0, 800.0, 1.5),
        Quantity("time in a train, s: 20 minutes, one sample", 0.0, 1200.0, 0.1),
        Quantity("axles of a cut: sorting list", 2.0, 400.0, 1.0),
    )


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
            Stored("cut records", counts.cuts, counts.record_bits, Memory.WORKING, "synth.hump.control.cut_record"),
            Stored("route store", counts.cuts, 8, Memory.WORKING, "a track number of at most 199 a cut"),
        )
    )


@dataclass(frozen=True)
class Channels:
    """Numbers of digital and analog inputs and outputs; they add up, and are multiplied."""

    digital_in: int = 0
    analog_in: int = 0
    digital_out: int = 0
    analog_out: int = 0

    def __add__(self, other: Channels) -> Channels:
        return Channels(
            self.digital_in + other.digital_in,
            self.analog_in + other.analog_in,
            self.digital_out + other.digital_out,
            self.analog_out + other.analog_out,
        )

    def __mul__(self, count: int) -> Channels:
        return Channels(
            self.digital_in * count, self.analog_in * count, self.digital_out * count, self.analog_out * count
        )


@dataclass(frozen=True)
class ChannelRules:
    """Channels of one element each, and why: `sources` by the name of the field. All are engineering judgement.

    `zone`: one braking zone of a retarder, which has valves and a gauge of its own. `retarder`: a position besides.
    """

    switch: Channels = Channels(digital_in=3, digital_out=2)
    section: Channels = Channels(digital_in=1)
    zone: Channels = Channels(analog_in=1, digital_out=5)
    retarder: Channels = Channels(digital_in=1)
    radar: Channels = Channels(analog_in=1)
    point_sensor: Channels = Channels(digital_in=2)
    axle_counter: Channels = Channels(digital_in=2)
    crest_signal: Channels = Channels(digital_in=1, digital_out=4)
    signal: Channels = Channels(digital_in=1, digital_out=2)
    sources: tuple[tuple[str, str], ...] = (
        ("switch", "detection left and right, free for throwing; commands left and right"),
        ("section", "occupied or free, also those of switches and retarders"),
        ("zone", "pressure of the cylinders; one digital output for the valve of each of five stages"),
        ("retarder", "ready, or in manual control"),
        ("radar", "the measured speed"),
        ("point_sensor", "two wheel sensors close together"),
        ("axle_counter", "two wheel sensors at a joint, which also tell the direction"),
        ("crest_signal", "lamp proved; stop, slow, faster and back"),
        ("signal", "lamp proved; stop and proceed"),
    )


@dataclass(frozen=True)
class CountedChannels:
    """How many elements of one kind, the channels of each, and of all."""

    kind: str
    count: int
    each: Channels

    @property
    def all(self) -> Channels:
        """Of all elements of the kind."""
        return self.each * self.count


def counted_channels(hump: HumpGraph, rules: ChannelRules) -> tuple[CountedChannels, ...]:
    """A row for every kind of element of `hump`, in the order of the rules.

    A switch has three axle counters, a retarder two, a section two, or one if the track ends in it. A joint that is
    the exit of one element and the entrance of the next has one counter for both in practice: so that row is an upper
    bound.
    """
    edges = [edge for vertex in hump.vertices for edge in vertex.edges]
    counters = (
        3 * sum(switch.axle_counters for switch in hump.switches)
        + 2 * sum(retarder.axle_counters for retarder in hump.retarders)
        + sum((1 if section.is_last else 2) for section in hump.sections if section.axle_counters)
    )
    counts = {
        "switch": len(hump.switches),
        "section": len(hump.switches) + len(hump.retarders) + len(hump.sections),
        "zone": sum(len(retarder.zones_m) for retarder in hump.retarders),
        "retarder": len(hump.retarders),
        "radar": sum(len(edge.radars) for edge in edges),
        "point_sensor": sum(len(edge.point_sensors) for edge in edges),
        "axle_counter": counters,
        "crest_signal": len(hump.leads),
        "signal": len(hump.signals) - len(hump.leads),
    }
    return tuple(CountedChannels(kind, count, getattr(rules, kind)) for kind, count in counts.items())


def total_channels(counted: tuple[CountedChannels, ...]) -> Channels:
    """The sum over all kinds."""
    return sum((row.all for row in counted), Channels())


def source_channels() -> Channels:
    """What [hump-computer-1970s] asks for: 150 inputs of either kind at least, 70 digital and 80 analog outputs.

    Its retarders were commanded by analog values, ours by stages; it had no axle counter a joint of its own.
    """
    return Channels(digital_in=150, analog_in=150, digital_out=70, analog_out=80)
