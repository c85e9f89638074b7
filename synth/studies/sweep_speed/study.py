"""How fast a sweep makes tables, what memory it takes, and what a book of 10 000 would need.

Sweeps one gondola of many masses to many exit speeds on the default grid by worker processes, from nothing: tables over
time, seconds of every class, highest memory of a worker beside the estimate that the limit of workers is taken from.
Then binds a large book from copies of these tables. Compiling is left out by a unit tuned before.
"""

from __future__ import annotations

import tempfile
import time
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from synth.studies.options import option
from synth.studies.study import Method, Tell, silent
from synth.studies.sweep_speed.binding import MIB, bound
from synth.studies.sweep_speed.findings import SweepSpeed, UnitRow
from synth.studies.timing.machine import this_machine
from synth.sweep.ledger import DONE, Event
from synth.sweep.local_workers import LocalWorkers
from synth.sweep.plan import Unit
from synth.sweep.run import fitting_workers, run_sweep, task_of
from synth.sweep.sweep_directory import held_sweep
from synth.sweep.sweep_file import parse_sweep
from synth.sweep.work import InThisProcess

LIGHTEST_T, HEAVIEST_T = 22.0, 84.0
SLOWEST_M_S, FASTEST_M_S = 1.25, 5.0


@dataclass(frozen=True)
class Options:
    """How large a sweep."""

    classes: int = option(63, "masses of the gondola", (1, 1000))
    targets: int = option(16, "exit speeds", (1, 100))
    workers: int = option(2, "worker processes", (1, 256))
    bind: int = option(10_000, "tables of the book that is bound from copies", (1, 10**6))


@dataclass(frozen=True)
class Told:
    """A watcher that passes everything on."""

    tell: Tell
    started_s: float = field(default_factory=time.monotonic)

    def note(self, sentence: str) -> None:
        """Besides the units."""
        self.tell(sentence)

    def done(self, unit: Unit, sentence: str) -> None:
        """A unit is done."""
        self.tell(sentence)


def run(options: Options, tell: Tell) -> SweepSpeed:
    """Sweep, read the ledger, bind."""
    machine = this_machine()
    with tempfile.TemporaryDirectory() as folder:
        warm, directory = Path(folder) / "warm", Path(folder) / "out"
        with held_sweep(warm) as found:
            task = task_of(parse_sweep(text_of(1, 1), "study sweep-speed"), found)
            run_sweep(task, found, InThisProcess(), Told(silent))
        with held_sweep(directory) as found:
            task = task_of(parse_sweep(text_of(options.classes, options.targets), "study sweep-speed"), found)
            workers, begun, watcher = fitting_workers(task, options.workers), time.time(), Told(tell)
            outcome = run_sweep(task, found, LocalWorkers(workers), watcher)
            total_s = time.monotonic() - watcher.started_s
            events = found.ledger().of(DONE)
        units = {unit.order.key: unit for unit in task.plan.units}
        return SweepSpeed(
            machine=machine,
            workers=workers,
            targets=options.targets,
            passes=task.file.settings.passes,
            total_s=total_s,
            failed=len(outcome.failures),
            units=tuple(unit_row(units[str(event["unit"])], event, begun) for event in events),
            binding=bound(directory, options.bind),
        )


def unit_row(unit: Unit, event: Event, begun: float) -> UnitRow:
    """What the ledger tells of a unit."""
    return UnitRow(
        unit=unit.order.label,
        mass_t=float(unit.order.tree["cut"][0]["mass_t"]),
        tables=int(event["tables"]),
        seconds=float(event["seconds"]),
        peak_mib=event["peak_bytes"] / MIB,
        estimate_mib=unit.memory_bytes / MIB,
        done_s=event["time_s"] - begun,
    )


def text_of(classes: int, targets: int) -> str:
    """The sweep as a file."""
    masses = [round(float(mass), 6) for mass in np.linspace(LIGHTEST_T, HEAVIEST_T, classes)]
    speeds = [round(float(speed), 6) for speed in np.linspace(SLOWEST_M_S, FASTEST_M_S, targets)]
    return f"[sweep]\nexit_speeds_m_s = {speeds}\n[[sweep.cut]]\ncar = 'gondola-4'\nmass_per_car_t = {masses}\n"


METHOD = Method(Options, Options(classes=2, targets=1, workers=1, bind=20), SweepSpeed, run)
