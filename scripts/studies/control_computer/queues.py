"""Every formula of waits beside the same queue request by request."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

from scripts.studies.control_computer.comparison import FEWEST_EVENTS, Comparison, judged, verdict
from scripts.studies.control_computer.lindley import Coverage, coverage
from scripts.studies.markdown_table import ABSENT, MarkdownTable, table
from scripts.studies.study import Tell
from synth.computer.sizing.batch_means import BATCHES
from synth.computer.sizing.demand_service import Discipline, mean_waits
from synth.computer.sizing.queue_simulation import CUT_SHARE, SimulatedWait, simulated_waits
from synth.computer.sizing.service_law import Constant, Erlang, Exponential, Hyperexponential, ServiceLaw
from synth.computer.sizing.task import Stream, total_load
from synth.computer.sizing.waiting_tail import sojourn_tail, start_tail
from synth.frame.interval import Interval
from synth.frame.workers.engine import Answer, answered
from synth.frame.workers.local_workers import LocalWorkers

LAWS: dict[str, ServiceLaw] = {
    "constant": Constant(1.0),
    "Erlang, 2 stages": Erlang(1.0, 2),
    "exponential": Exponential(1.0),
    "hyperexponential, c² = 3": Hyperexponential(1.0, 3.0),
}
"""Of one operation."""

MIXED = (
    Stream("constant", 0.4, Constant(0.5), 1),
    Stream("Erlang, 3 stages", 0.3, Erlang(0.8, 3), 2),
    Stream("exponential", 0.1, Exponential(0.5), 2),
    Stream("hyperexponential, c² = 3", 0.2, Hyperexponential(1.0, 3.0), 3),
)
"""Every law, three priorities, two tasks of one priority; load 0.69."""

NAMES = {Discipline.FIRST_COME: "first come", Discipline.RELATIVE: "relative", Discipline.ABSOLUTE: "absolute"}
BUSY = 0.7
LONG_SERVICES = 4.0
PUBLISHED_RATE_PER_S, PUBLISHED_SERVICE_S, PUBLISHED_LONG_S = 0.825, 8000.0 / 120_000.0, 0.1
LOADS = (0.3, 0.5, 0.8, 0.9)
COVERAGE_REQUESTS = 50_000


@dataclass(frozen=True)
class QueueRun:
    """A queue to simulate; `long_s` is the wait that is called long. `requests` include those that are cut away."""

    key: str
    streams: tuple[Stream, ...]
    discipline: Discipline
    long_s: float
    requests: int
    seed: int


@dataclass(frozen=True)
class TaskWaits:
    """One task of a run: mean time to the start and to the end, and how often each was long."""

    run: str
    order: str
    task: str
    load: float
    long_s: float
    kept: int
    start: Comparison
    end: Comparison
    long_start: Comparison
    long_end: Comparison

    @property
    def comparisons(self) -> tuple[Comparison, ...]:
        """All four."""
        return self.start, self.end, self.long_start, self.long_end


@dataclass(frozen=True)
class Queues:
    """All tasks of all runs, and how often intervals of such simulations hold the truth."""

    tasks: tuple[TaskWaits, ...]
    coverages: tuple[Coverage, ...]

    @property
    def comparisons(self) -> tuple[Comparison, ...]:
        """Of all tasks."""
        return tuple(each for task in self.tasks for each in task.comparisons)

    def tables(self) -> dict[str, MarkdownTable]:
        """`waits`, `tails`, `queues-verdict`, `coverage`."""
        queue = ("queue", "order", "service of the task")
        told, own, outside = verdict(self.comparisons)
        return {
            "waits": table(
                "formulas of mean waits beside simulated requests, with 95 % intervals",
                (*queue, "requests kept", "load", "to the start, s", "simulated", "to the end, s", "simulated"),
                ((t.run, t.order, t.task, str(t.kept), f"{t.load:.3g}", *pair(t.start), *pair(t.end))
                 for t in self.tasks),
            ),
            "tails": table(
                "formulas of long waits beside simulated requests, with 95 % intervals",
                (*queue, "long", "P(start is later)", "simulated", "P(end is later)", "simulated"),
                ((t.run, t.order, t.task, f"{t.long_s:g} s", *pair(t.long_start), *pair(t.long_end))
                 for t in self.tasks),
            ),
            "queues-verdict": table(
                "formulas beside simulations, all together",
                ("comparisons", "inside their own 95 % interval", "outside the joint limit"),
                [(str(told), str(own), str(outside))],
            ),
            "coverage": table(
                f"how often the interval of a simulation of {COVERAGE_REQUESTS} requests holds the mean wait of M/M/1",
                ("load", "runs", "held, %"),
                ((f"{c.load:g}", str(c.runs), f"{100 * c.held:.1f} ± {100 * c.half_width:.1f}")
                 for c in self.coverages),
            ),
        }  # fmt: skip


def pair(found: Comparison) -> tuple[str, str]:
    """The formula, and the simulation with its interval."""
    shown = f"{found.simulated:.4g} ± {found.half_width:.1g}" if found.told else ABSENT
    return f"{found.formula:.4g}", shown + (" **outside**" if found.outside else "")


def queue_runs(kept: int, seed: int) -> list[QueueRun]:
    """All runs; so many requests are kept in each, of all tasks together."""
    requests = int(kept / (1.0 - 2.0 * CUT_SHARE)) + BATCHES * len(MIXED)  # batches of equal length leave some out
    runs = [
        QueueRun(f"four tasks, {NAMES[each]}", MIXED, each, 3.0, requests, seed + place)
        for place, each in enumerate(Discipline)
    ]
    for place, (name, law) in enumerate(LAWS.items(), start=len(runs)):
        busy = (Stream(name, BUSY, law, 1),)
        light = (Stream(name, PUBLISHED_RATE_PER_S, law.scaled(PUBLISHED_SERVICE_S), 1),)
        first = Discipline.FIRST_COME
        runs.append(QueueRun(f"one task, {name}", busy, first, LONG_SERVICES, requests, seed + 10 + place))
        runs.append(QueueRun(f"published, {name}", light, first, PUBLISHED_LONG_S, requests, seed + 20 + place))
    return runs


def answer_run(run: QueueRun) -> Answer:
    """Simulate one."""
    return answered(run, simulated_run)


def simulated_run(run: QueueRun) -> tuple[SimulatedWait, ...]:
    """Its tasks."""
    return simulated_waits(run.streams, run.discipline, run.requests, run.seed, run.long_s)


def queues(kept: int, coverage_runs: int, workers: int, seed: int, tell: Tell) -> Queues:
    """Simulate all runs and put the formulas beside them."""
    runs = queue_runs(kept, seed)
    found: dict[str, tuple[SimulatedWait, ...]] = {}
    for each in LocalWorkers(workers, answer_run).answers(runs, lambda _: None):
        if each.result is None:
            raise RuntimeError(f"control-computer study: {each.reason}")
        found[each.key] = each.result
        tell(f"queue {len(found)} of {len(runs)}: {each.key}, {each.seconds:.0f} s")
    tasks = with_joint_limits([task for run in runs for task in compared(run, found[run.key])])
    held = tuple(coverage(load, COVERAGE_REQUESTS, coverage_runs, seed) for load in LOADS) if coverage_runs else ()
    tell("coverage of intervals counted")
    return Queues(tasks, held)


def compared(run: QueueRun, found: tuple[SimulatedWait, ...]) -> list[TaskWaits]:
    """The formulas of every task beside its simulation."""
    rows = []
    for told, mean in zip(mean_waits(run.streams, run.discipline), found, strict=True):
        start = start_tail(run.streams, run.discipline, told.task, run.long_s)
        end = sojourn_tail(run.streams, run.discipline, told.task, run.long_s)
        name = f"{run.key}: {told.task}"
        rows.append(
            TaskWaits(
                run=run.key.partition(",")[0],
                order=NAMES[run.discipline],
                task=told.task,
                load=total_load(run.streams),
                long_s=run.long_s,
                kept=sum(each.start_s.n for each in found),
                start=beside(f"{name}, mean time to the start", told.start_s, 0.0, mean.start_s),
                end=beside(f"{name}, mean time to the end", told.sojourn_s, 0.0, mean.sojourn_s),
                long_start=beside(f"{name}, long to the start", start.value, start.error, mean.long_share, share=True),
                long_end=beside(f"{name}, long to the end", end.value, end.error, mean.late_share, share=True),
            )
        )
    return rows


def beside(what: str, formula: float, error: float, found: Interval, share: bool = False) -> Comparison:
    """One comparison; a share that was hardly ever seen, or nearly always, is not told."""
    rarer = min(found.value, 1.0 - found.value) * found.n
    told = found.half_width > 0.0 and (not share or rarer >= FEWEST_EVENTS)
    return Comparison(what, formula, error, found.value, found.half_width, BATCHES - 1, found.n, told)


def with_joint_limits(tasks: Sequence[TaskWaits]) -> tuple[TaskWaits, ...]:
    """All comparisons of all tasks judged together."""
    limits = iter(judged(each for task in tasks for each in task.comparisons))
    return tuple(
        replace(task, start=next(limits), end=next(limits), long_start=next(limits), long_end=next(limits))
        for task in tasks
    )
