"""Controllers at the track: how fast each is, how it is called, and what one call of our controller code costs,
counted: the input from which loads and responses follow.
"""

from __future__ import annotations

import math
from dataclasses import dataclass


@dataclass(frozen=True)
class CallCosts:
    """Counted operations of the dearest call of each function, and `source`: how they were counted.

    `observe`: a step of the estimator. `decide`: a decision at rest. `select`: the table of a cut. `aim`: the exit
    speed from an aim table, 0 where there are none. `intact`: the checksum of one table, None if there is none in that
    language; it is for the start only.
    """

    observe: int
    decide: int
    select: int
    aim: int
    intact: int | None
    source: str

    @property
    def sample(self) -> int:
        """Of one sample: an estimate and a decision."""
        return self.observe + self.decide

    @property
    def cut(self) -> int:
        """Of one cut besides: its exit speed, and its table."""
        return self.aim + self.select


def c_costs() -> CallCosts:
    """Instructions of the exported C on x86-64, gcc 12 -Os, by callgrind, tables with estimators.

    All but `aim` are kept findings of the study controller-cost (docs/studies/controller-cost.json). `aim` was counted
    the same way, gcc 12 -Os: the dearest of 3 000 hard questions to 19 tables with up to 7 × 7 × 8 nodes an axis.
    """
    return CallCosts(
        observe=791,
        decide=440,
        select=101_798,
        aim=451,
        intact=33_570,
        source="instructions on x86-64, gcc 12 -Os, callgrind: study controller-cost; aim counted apart",
    )


def st_costs() -> CallCosts:
    """Operations of the exported Structured Text, counted in its parse tree (docs/reference/structured-text.md).

    `select`: between two tables in a book of 6, then each of 9 tables more, and the copy of an estimator of 16 breaks,
    the difference of the two loads: put together, not counted in one. `aim`: the choice of the aim table, its load, and
    one question. There is no checksum.
    """
    return CallCosts(
        observe=550,
        decide=471,
        select=1604 + 9 * 9 + 524 - 338,
        aim=178 + 2178 + 399,
        intact=None,
        source="operations of Structured Text as executed: docs/reference/structured-text.md",
    )


@dataclass(frozen=True)
class ScanCycle:
    """A cycle that begins every `period_s`; the system takes `overhead_s` of it for inputs, outputs and itself.

    Input filters and output stages delay by `input_s` and `output_s`.
    """

    period_s: float
    overhead_s: float = 0.0
    input_s: float = 0.0
    output_s: float = 0.0

    def used_share(self, work_s: float) -> float:
        """The share of the cycle that a program of `work_s` and the system take; above 1 it does not fit."""
        return (self.overhead_s + work_s) / self.period_s

    def fits(self, work_s: float) -> bool:
        """Whether a program of `work_s` at most ends within the cycle."""
        return self.overhead_s + work_s <= self.period_s

    def longest_response_s(self, work_s: float) -> float:
        """From a change at an input to that at the output, at most; inf where the program does not fit.

        A change just after the inputs were read waits for the next cycle, which reads, runs and writes:
        filter + period + overhead + work + output stage. Outputs are written when the program ends.
        """
        if not self.fits(work_s):
            return math.inf
        return self.input_s + self.period_s + self.overhead_s + work_s + self.output_s


@dataclass(frozen=True)
class TracksideController:
    """A controller that runs code with `costs`.

    One counted operation becomes `instructions` of its own, each of `cycles` in the worst mean, at `clock_hz`. With a
    `scan` it runs all in a cycle; without, a sample calls the program at most `latency_s` after it is there, and it
    interrupts what is less urgent. `source` says what of this is known and what assumed.
    """

    name: str
    clock_hz: float
    cycles: float
    instructions: float
    costs: CallCosts
    source: str
    scan: ScanCycle | None = None
    latency_s: float = 0.0

    @property
    def operation_s(self) -> float:
        """Time of one counted operation."""
        return self.instructions * self.cycles / self.clock_hz

    @property
    def sample_s(self) -> float:
        """Work of one sample of one position."""
        return self.costs.sample * self.operation_s

    @property
    def cut_s(self) -> float:
        """Work of one cut at one position, besides its samples."""
        return self.costs.cut * self.operation_s


def plc() -> TracksideController:
    """A programmable controller of the lower middle class with a scan of 10 ms, in Structured Text."""
    return TracksideController(
        name="PLC, 10 ms scan",
        clock_hz=1.0 / 384e-9,
        cycles=1.0,
        instructions=1.0,
        costs=st_costs(),
        scan=ScanCycle(period_s=0.010, overhead_s=0.001, input_s=0.003, output_s=0.001),
        source=(
            "384 ns: typical floating-point operation of a CPU 1511-1 PN, the dearest kind (Siemens, S7-1500 cycle and "
            "reaction times, A5E03461503, 02/2014, table 3-2). Assumed: every counted operation takes that; 1 ms of "
            "the scan for the system, input filter 3 ms, output 1 ms"
        ),
    )


def cortex_m4() -> TracksideController:
    """A microcontroller with a Cortex-M4 and its unit for binary32, in C."""
    return TracksideController(
        name="Cortex-M4, 168 MHz",
        clock_hz=168e6,
        cycles=2.0,
        instructions=1.5,
        costs=c_costs(),
        latency_s=10e-6,
        source=(
            "assumed: 168 MHz, 2 cycles an instruction (most take 1, loads and branches 2 to 4, a division 14, flash "
            "waits on top), 1.5 instructions for one of x86-64, which can operate on memory; interrupt within 10 µs"
        ),
    )


def industrial_pc() -> TracksideController:
    """An industrial PC with a real-time kernel, one core, in C."""
    return TracksideController(
        name="industrial PC, 2 GHz",
        clock_hz=2e9,
        cycles=2.0,
        instructions=1.0,
        costs=c_costs(),
        latency_s=100e-6,
        source=(
            "assumed: one core of 2 GHz, 2 cycles an instruction with cold caches, and a real-time kernel that calls "
            "the program within 0.1 ms; an ordinary kernel promises nothing"
        ),
    )


def usual_controllers() -> tuple[TracksideController, ...]:
    """One of each class; the user's own may stand beside them."""
    return plc(), cortex_m4(), industrial_pc()
