"""A block diagram: parts, and the wires that follow from their signals."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass

from synth.simulation.structure.part import Part


@dataclass(frozen=True, order=True)
class Wire:
    """A signal on its way from a part to a part, both by name; '' for the outside."""

    signal: str
    source: str
    target: str


@dataclass(frozen=True)
class Box:
    """A part as it is drawn: its name, its symbol in the source, the name of its block."""

    name: str
    symbol: str
    block: str


@dataclass(frozen=True)
class Sketch:
    """What is drawn of a diagram: plain values."""

    title: str
    boxes: tuple[Box, ...]
    wires: tuple[Wire, ...]


@dataclass(frozen=True, eq=False)
class Diagram:
    """The parts of a closed loop. `ValueError` for two parts of a name or two that give the same signal."""

    title: str
    parts: tuple[Part, ...]

    def __post_init__(self) -> None:
        for kind, names in (
            ("parts of the name", [part.name for part in self.parts]),
            ("parts that give", [signal for part in self.parts for signal in part.outputs]),
        ):
            [(name, count)] = Counter(names).most_common(1)
            if count > 1:
                raise ValueError(f"diagram: there are {count} {kind} {name}")

    def __getitem__(self, name: str) -> Part:
        """The part of this name; `KeyError` if there is none."""
        for part in self.parts:
            if part.name == name:
                return part
        raise KeyError(name)

    @property
    def wires(self) -> tuple[Wire, ...]:
        """Every signal from where it comes to where it goes, sorted; a signal that nobody takes has no wire."""
        source = {signal: part.name for part in self.parts for signal in part.outputs}
        return tuple(
            sorted(Wire(signal, source.get(signal, ""), part.name) for part in self.parts for signal in part.inputs)
        )

    @property
    def sketch(self) -> Sketch:
        """What is drawn of it."""
        return Sketch(self.title, tuple(Box(p.name, p.symbol, p.block.value) for p in self.parts), self.wires)

    @property
    def outside(self) -> tuple[str, ...]:
        """The signals that come from outside the loop."""
        return tuple(dict.fromkeys(wire.signal for wire in self.wires if not wire.source))
