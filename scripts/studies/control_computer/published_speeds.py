"""Speeds of the published control computer, worked through again: cyclic service, queues by law, priorities."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import count

from scripts.studies.study import MarkdownTable, table
from synth.computer.sized_computer import AllowedWait, largest_tail, longest_mean_s, needed_speed
from synth.computer.sizing.service import Cycle, Discipline, cyclic_speed, mean_waits, used_share
from synth.computer.sizing.task import Constant, Erlang, Exponential, Hyperexponential, ServiceLaw, Task, TaskMix
from synth.computer.sizing.waiting_tail import start_tail
from synth.frame.settings.settings_file import changed

LAWS: dict[str, ServiceLaw] = {
    "constant": Constant(1.0),
    "Erlang, 2 stages": Erlang(1.0, 2),
    "exponential": Exponential(1.0),
    "hyperexponential, c² = 3": Hyperexponential(1.0, 3.0),
}
"""Of one operation."""

NAMES = {Discipline.FIRST_COME: "first come", Discipline.RELATIVE: "relative", Discipline.ABSOLUTE: "absolute"}
RATE_PER_S = 0.825
CYCLE = Cycle()
"""(1 − δ)/(1 + α) = 0.5, however it is divided."""

OPERATIONS_A_CYCLE = {"open loop": 10_000.0, "feedback": 500_000.0}
USES = (0.07, 0.08)
SLOW_OP_S, FAST_OP_S, FAST_OPERATIONS = 1500.0, 120_000.0, 8000.0
MEAN_S, LONG_S, LONG_SHARE = 0.01, 0.1, 0.001
BY_MEAN, BY_TAIL = AllowedWait(mean_s=MEAN_S), AllowedWait(long_s=LONG_S, share=LONG_SHARE)
CLASSES = 3


@dataclass(frozen=True)
class CyclicUse:
    """Cyclic service of one control: the speed, what share one use would make of the queue's requests, and the
    operations a request that give the published use of 7 and 8 %, with checks counted as work and without."""

    control: str
    speed_op_s: float
    queue_share: float
    with_checks: tuple[float, float]
    without_checks: tuple[float, float]


@dataclass(frozen=True)
class LawClaims:
    """Both published claims under one law of service.

    At 120 000 op/s with 8 000 operations: the mean wait and P(W > 0.1 s). At 1 500 op/s: the most operations that keep
    either. `needed_op_s`: the speed at which 8 000 operations keep both.
    """

    law: str
    mean_s: float
    long_share: float
    most_by_mean: float
    most_by_tail: float
    needed_op_s: float

    @property
    def kept(self) -> tuple[bool, bool]:
        """Mean wait below 0.01 s; P(W > 0.1 s) at most 0.001."""
        return self.mean_s < MEAN_S, self.long_share <= LONG_SHARE


@dataclass(frozen=True)
class PriorityWait:
    """Mean wait and P(W > 0.1 s) of one of three equal classes, constant service, 120 000 op/s."""

    order: str
    priority: int
    mean_s: float
    long_share: float


@dataclass(frozen=True)
class PublishedSpeeds:
    """All of them; `needed_by_order`: least speed with a mean wait of 0.01 s for every class, by order of service;
    `erlang_stages`: the fewest stages with which Erlang service keeps both claims at 120 000 op/s."""

    cyclic: tuple[CyclicUse, ...]
    laws: tuple[LawClaims, ...]
    priorities: tuple[PriorityWait, ...]
    needed_by_order: dict[str, float]
    erlang_stages: int

    def tables(self) -> dict[str, MarkdownTable]:
        """`laws`, `priorities`."""
        return {
            "laws": table(
                "the two claims on waits by the law of service, first come, 0.825 requests a second",
                ("service", "120 000 op/s, 8 000 operations: mean wait, s", "P(W > 0.1 s)", "W < 0.01 s",
                 "P ≤ 0.001", "both need, op/s", "1 500 op/s: most operations for W ≤ 0.01 s", "for P ≤ 0.001"),
                ((law.law, f"{law.mean_s:.5f}", f"{law.long_share:.2g}", *map(yes, law.kept),
                  f"{law.needed_op_s:.0f}", f"{law.most_by_mean:.0f}", f"{law.most_by_tail:.0f}")
                 for law in self.laws),
            ),
            "priorities": table(
                "three equal classes, constant service of 8 000 operations, 120 000 op/s",
                ("order", "class", "mean wait, s", "P(W > 0.1 s)", "speed for W ≤ 0.01 s in every class, op/s"),
                ((p.order, str(p.priority), f"{p.mean_s:.5f}", f"{p.long_share:.2g}",
                  f"{self.needed_by_order[p.order]:.0f}") for p in self.priorities),
            ),
        }  # fmt: skip

    def faults(self) -> tuple[str, ...]:
        """What is said of the laws must hold."""
        right = {"constant": (True, True), "exponential": (True, False)}
        return tuple(
            f"published claims under {law.law} service: {law.kept} were found, {right[law.law]} are told"
            for law in self.laws
            if law.law in right and law.kept != right[law.law]
        )


def yes(kept: bool) -> str:
    """In a cell."""
    return "yes" if kept else "no"


def published_speeds() -> PublishedSpeeds:
    """All parts; a second or two."""
    return PublishedSpeeds(
        tuple(cyclic_use(control) for control in OPERATIONS_A_CYCLE),
        tuple(law_claims(name, law) for name, law in LAWS.items()),
        tuple(wait for order in Discipline for wait in priority_waits(order)),
        {NAMES[order]: needed_speed(classes(), order, BY_MEAN) for order in Discipline},
        fewest_stages(),
    )


def fewest_stages() -> int:
    """Of Erlang service that keeps P(W > 0.1 s); the mean wait is kept by every law here."""
    return next(
        stages
        for stages in count(1)
        if largest_tail(one_task(Erlang(FAST_OPERATIONS, stages)), Discipline.FIRST_COME, FAST_OP_S, LONG_S)
        <= LONG_SHARE
    )


def cyclic_use(control: str) -> CyclicUse:
    """Of open loop or feedback."""
    speed = cyclic_speed(changed(CYCLE, operations=OPERATIONS_A_CYCLE[control]))
    low, high = (operations_for_use(use, speed, RATE_PER_S, CYCLE, True) for use in USES)
    less, more = (operations_for_use(use, speed, RATE_PER_S, CYCLE, False) for use in USES)
    share = used_share(one_task(Constant(FAST_OPERATIONS)), speed, CYCLE, checks_count=True)
    return CyclicUse(control, speed, share, (low, high), (less, more))


def operations_for_use(share: float, speed_op_s: float, rate_per_s: float, cycle: Cycle, checks_count: bool) -> float:
    """The mean number of operations a request that gives `share`: `used_share` solved for L.

    It shows that three figures of [hump-computer-1970s] are of different mixes of tasks. At 20 000 op/s (open loop) a
    use of 7 to 8 % and 0.825 requests a second give L from 850 to 1 940; a wait below 0.01 s at 1 500 op/s allows 219
    at most. At 10⁶ op/s (feedback) they give 42 000 to 97 000; the same work has 8 000 in the text.
    """
    operations = share * speed_op_s / rate_per_s
    return operations * cycle.useful_share if checks_count else operations


def one_task(law: ServiceLaw) -> TaskMix:
    """All requests as one task."""
    return TaskMix((Task("all", RATE_PER_S, law),))


def law_claims(name: str, law: ServiceLaw) -> LawClaims:
    """`law` of one operation in the mean.

    Speed and operations have one ratio, so the speed for one operation tells the operations for a speed.
    """
    first, one, many = Discipline.FIRST_COME, one_task(law), one_task(law.scaled(FAST_OPERATIONS))
    both = AllowedWait(MEAN_S, LONG_S, LONG_SHARE)
    return LawClaims(
        law=name,
        mean_s=longest_mean_s(many, first, FAST_OP_S),
        long_share=largest_tail(many, first, FAST_OP_S, LONG_S),
        most_by_mean=SLOW_OP_S / needed_speed(one, first, BY_MEAN),
        most_by_tail=SLOW_OP_S / needed_speed(one, first, BY_TAIL),
        needed_op_s=needed_speed(many, first, both),
    )


def classes() -> TaskMix:
    """The same requests in equal classes, as from the positions in turn."""
    return TaskMix(
        tuple(Task(f"class {k}", RATE_PER_S / CLASSES, Constant(FAST_OPERATIONS), k) for k in range(1, CLASSES + 1))
    )


def priority_waits(order: Discipline) -> list[PriorityWait]:
    """Of every class."""
    streams = classes().streams(FAST_OP_S)
    return [
        PriorityWait(NAMES[order], stream.priority, wait.start_s, start_tail(streams, order, stream.name, LONG_S).value)
        for stream, wait in zip(streams, mean_waits(streams, order), strict=True)
    ]
