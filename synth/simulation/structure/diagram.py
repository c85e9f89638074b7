"""A block diagram: its parts, and the wires that follow from their signals.

The functions of the parts are those that the simulator runs. A part adds to one of them which signal each argument is,
so that a diagram, a table and a step-by-step run all follow from the same lines.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from enum import Enum
from typing import Any

CLOCK = frozenset({"t", "Δt", "n", "tₙ"})
"""Times and counters, which no wire carries."""


class Block(Enum):
    """The blocks of the functional scheme (zhukovitsky-2012, figure 3)."""

    MEASURING = "measuring block"
    COMPUTER = "control computer"
    PRESSURE = "pressure regulator and drive"
    PADS = "brake pads"
    CUT = "cut"


@dataclass(frozen=True)
class Number:
    """A constant of a part: symbol, value, unit ('' where there is none)."""

    symbol: str
    value: float
    unit: str = ""

    @property
    def text(self) -> str:
        """'tZ2 = 0.1 s'."""
        return f"{self.symbol} = {self.value:g} {self.unit}".rstrip()


@dataclass(frozen=True, eq=False)
class Part:
    """One element of the diagram.

    `takes`: (argument of the law, signal); `given`: (argument of the law, value) that the plant or the table fixes;
    `gives`: the signals in the order of the law's results, '' for a result that is none. `hands_on`: (signal, signal
    after it) of a part that passes a signal on at the instants or after the delay that its law tells. `waits_for`: a
    signal that keeps the part from acting until it is 0. `undrawn`: signals that the law takes only because one closed
    form computes several parts; no wire leads to this one. `does`: what it does, one clause; `numbers`: its constants.
    """

    name: str
    symbol: str
    block: Block
    does: str
    law: Callable[..., Any]
    takes: tuple[tuple[str, str], ...]
    gives: tuple[str, ...]
    given: tuple[tuple[str, Any], ...] = ()
    hands_on: tuple[tuple[str, str], ...] = ()
    waits_for: tuple[str, ...] = ()
    undrawn: tuple[str, ...] = ()
    numbers: tuple[Number, ...] = ()

    @property
    def law_name(self) -> str:
        """Module and name of the law."""
        law = getattr(self.law, "py_func", self.law)  # that of a kernel
        law = getattr(law, "__func__", law)
        return f"{law.__module__}.{law.__qualname__}"

    @property
    def inputs(self) -> tuple[str, ...]:
        """The signals that wires bring, each once."""
        brought = [*(before for before, _ in self.hands_on), *(signal for _, signal in self.takes), *self.waits_for]
        own = {*self.outputs} - {before for before, _ in self.hands_on}
        return tuple(s for s in dict.fromkeys(brought) if s not in own and s not in CLOCK and s not in self.undrawn)

    @property
    def outputs(self) -> tuple[str, ...]:
        """The signals that the part gives or hands on."""
        given = [*self.gives, *(after for _, after in self.hands_on)]
        return tuple(s for s in given if s and s not in CLOCK)

    def run(self, signals: Mapping[str, Any], **other: Any) -> dict[str, Any]:
        """What the law gives for `signals`; `other` takes the place of values that are given."""
        arguments = {**dict(self.given), **{name: signals[signal] for name, signal in self.takes}, **other}
        result = self.law(**arguments)
        found = {self.gives[0]: result} if len(self.gives) == 1 else dict(zip(self.gives, result, strict=True))
        return {signal: value for signal, value in found.items() if signal}


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
