"""How many inputs and outputs the control computer needs: counted over the elements of a hump, by stated rules."""

from __future__ import annotations

from dataclasses import dataclass

from plant_models.hump import HumpGraph


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
