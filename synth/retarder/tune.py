"""The main job: a whole table book from a resolved configuration, for regulators with any decision epochs.

Work runs on a few threads, on two levels: a start prepares something large, the tasks that it returns use it.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, replace
from functools import partial
from threading import Condition
from typing import Generic, TypeVar

from plant_models import Plant
from synth.frame.version import creation_time
from synth.frame.workers.engine import Watcher
from synth.retarder.class_setup import origin_of, validation_passes
from synth.retarder.configuration.resolved_config import ResolvedConfig
from synth.retarder.epochs import Epochs, Ground, Store, Table
from synth.retarder.failed_case import FailedCase, attempted, parted, require_none
from synth.retarder.tuned_case import Case, TunedCase
from synth.solver.chain.grid import require_memory
from synth.solver.descent import one_blas_thread

Result = TypeVar("Result")
Start = Callable[[], Sequence[Callable[[], Result]]]


def run_nested(starts: Sequence[Start[Result]], workers: int) -> list[list[Result]]:
    """Results of all tasks, by start and in the order in which the start returned them.

    Tasks go before further starts, so that at most about `workers` preparations are in memory; idle threads
    take tasks of any start, so that the last ones end together. The first exception ends the queue and is
    raised.
    """
    queue = NestedQueue(starts)
    with ThreadPoolExecutor(max_workers=workers) as pool:
        for turn in [pool.submit(queue.work) for _ in range(workers)]:
            turn.result()
    return queue.results


class NestedQueue(Generic[Result]):
    """State shared by the threads of `run_nested`."""

    def __init__(self, starts: Sequence[Start[Result]]) -> None:
        self.results: list[list[Result]] = [[] for _ in starts]
        self._starts = deque(enumerate(starts))
        self._tasks: deque[tuple[int, int, Callable[[], Result]]] = deque()
        self._starting = 0
        self._failed = False
        self._changed = Condition()

    def work(self) -> None:
        """Take tasks, else starts, until there are none and no start is under way."""
        while (action := self._next()) is not None:
            try:
                action()
            except BaseException:
                with self._changed:
                    self._failed = True
                    self._changed.notify_all()
                raise

    def _next(self) -> Callable[[], None] | None:
        with self._changed:
            while not self._failed:
                if self._tasks:
                    index, place, task = self._tasks.popleft()
                    return lambda: self._run(index, place, task)
                if self._starts:
                    first, start = self._starts.popleft()
                    self._starting += 1
                    return lambda: self._begin(first, start)
                if self._starting == 0:
                    return None
                self._changed.wait()
            return None

    def _begin(self, index: int, start: Start[Result]) -> None:
        tasks = list(start())
        with self._changed:
            self.results[index] = [None] * len(tasks)  # type: ignore[list-item]  # each is set by its task
            self._tasks.extend((index, place, task) for place, task in enumerate(tasks))
            self._starting -= 1
            self._changed.notify_all()

    def _run(self, index: int, place: int, task: Callable[[], Result]) -> None:
        result = task()
        with self._changed:
            self.results[index][place] = result


Made = TypeVar("Made")

CaseDone = Callable[[Case], None]


def no_notice(case: TunedCase) -> None:
    """Nobody wants to know of a finished case."""


@dataclass(frozen=True)
class Book(Generic[Case]):
    """Result of a tune: all cases, classes in the order of the configuration.

    `failed`: cases without a table, which are not among `cases`.
    """

    config: ResolvedConfig
    created: str
    cases: tuple[Case, ...]
    failed: tuple[FailedCase, ...] = ()

    @property
    def whole(self) -> tuple[Case, ...]:
        """All cases, for who needs every one; `PlantError` where one has no table."""
        require_none(self.failed)
        return self.cases


@one_blas_thread()
def tune(
    config: ResolvedConfig,
    epochs: Epochs[Case, Table],
    store: Store[Table],
    watcher: Watcher,
    workers: int = 2,
    case_done: CaseDone[Case] = no_notice,
) -> Book[Case]:
    """Tune every cut class and target of `config`; each table is handed to `store` as soon as it is made.

    Work runs on `workers` threads (the kernels release the interpreter); the result does not depend on how
    many. `watcher` is told a sentence whenever a case has ended, `case_done` given its result. A case that no table can
    be made for is told of in the book, and the others are made.
    """
    for label, plant in config.plants():
        require_memory(label, *epochs.grids(config, plant), workers)
    ground = Ground(config, origin_of(config.sha256, creation_time()), validation_passes(config), store)

    def done(case: Case) -> None:
        case_done(case)
        tell(case, watcher)

    cases, failed = every_case(config, partial(epochs.cases, ground), done, watcher, workers)
    return Book(config, ground.origin.created, cases, failed)


def tell(case: TunedCase, watcher: Watcher) -> None:
    """What there is to say of a case with a table."""
    name, found = f"{case.label} to {case.target_speed_m_s:g} m/s", case.statistics
    watcher.done(f"{name}: {found.rms_text} in {found.passes} passes")
    for warning in case.warnings:
        watcher.note(f"warning: {name}: {warning}")
    for remark in case.remarks:
        watcher.note(f"{name}: {remark}")


def every_case(
    config: ResolvedConfig,
    prepare: Callable[[str, Plant], Sequence[Callable[[], Made]]],
    done: Callable[[Made], None],
    watcher: Watcher,
    workers: int,
) -> tuple[tuple[Made, ...], tuple[FailedCase, ...]]:
    """Every case of `config` that can be made, and the others, each in the order of the configuration.

    `prepare` is given a cut class, the heaviest first, and returns what makes the case of each of its targets. A case
    that is made is given to `done`; of one that fails `watcher` is told. Work runs on `workers` threads.
    """

    def ended(case: Made | FailedCase) -> Made | FailedCase:
        if isinstance(case, FailedCase):
            watcher.done(case.sentence)
        else:
            done(case)
        return case

    def case_of(label: str, target_m_s: float, make: Callable[[], Made]) -> Made | FailedCase:
        return ended(attempted(make, label, target_m_s, config))

    def start(label: str, plant: Plant) -> list[Callable[[], Made | FailedCase]]:
        targets = config.targets_of(label)
        makers = attempted(partial(prepare, label, plant), label, targets[0], config)
        if isinstance(makers, FailedCase):
            return [partial(ended, replace(makers, target_m_s=target)) for target in targets]
        return [partial(case_of, label, target, make) for target, make in zip(targets, makers, strict=True)]

    plants = config.plants()
    heaviest_first = sorted(range(len(plants)), key=lambda i: -plants[i][1].top_stage * plants[i][1].cut.mass_t)
    found = run_nested([partial(start, *plants[i]) for i in heaviest_first], workers)
    by_class = dict(zip(heaviest_first, found, strict=True))
    return parted(result for index in range(len(plants)) for result in by_class[index])
