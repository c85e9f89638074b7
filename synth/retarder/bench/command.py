"""The command `bench`: the simulated position in real time, and the score of the controller that commands it."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import nullcontext
from dataclasses import dataclass
from typing import TYPE_CHECKING

from synth.frame.command import Asked, Command, Limit, Steps, Unfinished, Work
from synth.frame.exhibits import Chapter
from synth.retarder.bench.options import Address, BenchOptions
from synth.retarder.configuration.resolved_config import ResolvedConfig
from synth.retarder.configured import configuration_of, given_config, head_of, made_elsewhere
from synth.retarder.exit_figures import MODEL_ONLY

if TYPE_CHECKING:
    from synth.retarder.bench.bench_pass import BenchCase, BenchPass
    from synth.retarder.bench.exchange import Clock
    from synth.retarder.bench.score import Errors, FoundBench
    from synth.retarder.served_class import ServedClass
    from tuning_tables import ControllerTable
    from tuning_tables.table_book import TableBook

LIMITS_OF_USE = (
    MODEL_ONLY,
    "A few dozen cuts tell nothing of the rare ones that no brake holds: 'retarder-synth validate' does.",
    "The bench is a model at the end of a cable. It is no test of safety.",
)


@dataclass(frozen=True)
class AskedBench:
    """The book, the tables that a controller chooses with the classes that they are for, and what was typed."""

    config: ResolvedConfig
    warnings: tuple[str, ...]
    book: TableBook
    tables: tuple[tuple[ControllerTable, ServedClass], ...]
    passes: int
    seed: int
    in_step: bool
    addresses: Mapping[str, Address]


def resolve(asked: Asked[ResolvedConfig | None, BenchOptions]) -> AskedBench:
    """The tables; refused where one has no class, a drive takes no command at any moment, or nothing can listen."""
    from synth.retarder.bench.servers import require_possible
    from synth.retarder.forms.tables_at import tables_at
    from synth.retarder.served_class import served_class
    from tuning_tables.table_book import TableBook

    options = asked.options
    tables = tables_at(options.source).only_lines("bench")
    config, source = configuration_of(asked, tables)
    book = TableBook(tables)
    unused = {table.id for table in book.shadowed()}
    chosen = tuple((table, served_class(table, config, source)) for table in tables if table.id not in unused)
    for _, each in chosen:
        each.plant.drive_at_any_time()
    never = (f"no controller chooses {each}, so its cuts do not come" for each in sorted(unused))
    wide = (f"{flag} is {at}: whoever reaches it can connect" for flag, at in options.addresses.items() if at.is_wide)
    warnings = (*made_elsewhere(tables, config, source), *never, *wide)
    require_possible(options.addresses)
    seed = config.validation.seed if options.seed is None else options.seed
    return AskedBench(config, warnings, book, chosen, options.passes, seed, options.in_step, options.addresses)


def compute(asked: AskedBench, work: Work) -> FoundBench:
    """The run; `Unfinished` where no controller answered."""
    from synth.kernels.cache import guarded

    return guarded(benched, asked, work)


def benched(asked: AskedBench, work: Work) -> FoundBench:
    """The same, where kernels are loaded."""
    from synth.retarder.bench.bench_pass import class_seeds, coming_cuts
    from synth.retarder.bench.exchange import Cycles, Exchange, InStep, RealTime, before_all_others
    from synth.retarder.bench.live_run import PAGE, LiveRun, live_page
    from synth.retarder.bench.run import Bench, Patience
    from synth.retarder.bench.score import FoundBench
    from synth.retarder.bench.servers import listening

    cuts = coming_cuts(asked.seed, len(asked.tables), asked.passes)
    cases = cases_of(asked, class_seeds(asked.seed, len(asked.tables)))
    sensor = asked.tables[0][1].plant.sensor
    patience, exchange = Patience(), Exchange(max(case.loop.stages for case in cases))
    live = LiveRun(asked.config.title, len(cuts), exchange)
    clock: Clock = InStep(patience.silent_s) if asked.in_step else RealTime(sensor.sample_period_s)
    pages: Mapping[str, Callable[[], bytes]] = {"/": lambda: live_page(asked.config.title), PAGE: live.document}
    bench = Bench(exchange, clock, sensor.sample_period_s, patience, work.progress.note)
    first = nullcontext(False) if asked.in_step else before_all_others()
    with first as is_first, listening(exchange, asked.addresses, pages):
        for flag, address in asked.addresses.items():
            work.progress.note(f"{flag.removeprefix('--')} at {address}")
        work.progress.note("waiting for a controller")
        passes = bench.run(cases, cuts, live, work.progress.done)
        traffic = exchange.traffic
    if not passes:
        raise Unfinished("no controller answered, so no cut came")
    return FoundBench(
        asked.config.title,
        sensor.sample_period_s,
        sensor.computing_delay_s,
        asked.seed,
        asked.passes,
        passes,
        tuple(errors_by_case(cases, passes, asked.seed)),
        traffic,
        Cycles(clock.period_s, tuple(clock.cycles_s), is_first) if isinstance(clock, RealTime) else None,
        asked.config.acceptance.prediction_ratio_low,
    )


def cases_of(asked: AskedBench, seeds: Sequence[int]) -> list[BenchCase]:
    """The cuts of each table, as many as can come."""
    from synth.retarder.bench.bench_pass import bench_case

    rounds = -(-asked.passes // len(asked.tables))
    return [
        bench_case(table, asked.book.number_of(table.cut.category), served, seed, rounds)
        for (table, served), seed in zip(asked.tables, seeds, strict=True)
    ]


def errors_by_case(cases: Sequence[BenchCase], passes: Sequence[BenchPass], seed: int) -> Iterator[Errors]:
    """Those of each case that came."""
    from synth.retarder.bench.score import errors_of

    for at, case in enumerate(cases):
        own = [each for each in passes if each.case == at]
        if own:
            yield errors_of(case, own, seed + 1)


def limits(found: FoundBench) -> Iterator[Limit]:
    """Whether the promise is kept, the controller is as good as its table, and the clock was."""
    from synth.retarder.bench.shown import limits_of

    return limits_of(found)


def show(found: FoundBench) -> Iterator[Chapter]:
    """What is shown of it."""
    from synth.retarder.bench.shown import chapters

    return chapters(found)


COMMAND = Command(
    name="bench",
    read=given_config,
    options=BenchOptions,
    resolve=resolve,
    head=lambda asked: head_of(asked.config, asked.warnings),
    steps=lambda asked: Steps(asked.passes, "braking", "cuts"),
    compute=compute,
    show=show,
    limits=limits,
    limits_of_use=LIMITS_OF_USE,
)
