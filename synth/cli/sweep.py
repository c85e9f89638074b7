"""`retarder-synth sweep`: a run, its status, what failed."""

from __future__ import annotations

import sys
import time
from pathlib import Path
from typing import TYPE_CHECKING, Any

from synth.frame.input_error import InputError
from synth.frame.processors import available
from synth.frame.terminal.telling import LIMITS_MISSED, OK, say

if TYPE_CHECKING:
    from synth.frame.terminal.progress import Progress
    from synth.frame.workers.engine import Engine
    from synth.retarder.sweep.plan import Unit
    from synth.retarder.sweep.run import Task
    from synth.retarder.sweep.sweep_directory import SweepDirectory


def sweep_command(
    words: list[Path], output: Path | None, workers: int | None, scheduler: str | None, as_json: bool
) -> int:
    """`words` as on the command line: a configuration, or 'status' or 'failed' and a directory; the exit code."""
    match [str(word) for word in words]:
        case ["status", directory]:
            return status_command(Path(directory), as_json)
        case ["failed", directory]:
            return failed_command(Path(directory), as_json)
        case [config]:
            if output is None:
                raise InputError("sweep: no directory for the results is given; give one by -o DIR")
            if workers is not None and scheduler is not None:
                raise InputError("sweep: --workers and --scheduler are both given; leave one out")
            return run_command(Path(config), output, workers, scheduler, as_json)
    raise InputError(
        f"sweep: {' '.join(map(str, words))} is not understood; give CONFIG.toml, status DIR or failed DIR"
    )


def run_command(path: Path, output: Path, workers: int | None, scheduler: str | None, as_json: bool) -> int:
    """Run or resume the sweep in the file `path` into the directory `output`."""
    from synth.frame.creation_time import require_date
    from synth.retarder.configured import sensors_left_aside
    from synth.retarder.sweep.run import run_sweep, task_of
    from synth.retarder.sweep.sweep_directory import held_sweep
    from synth.retarder.sweep.sweep_file import load_sweep

    file = load_sweep(path)
    require_date()
    reads = [path, *(Path(each.place) for condition in file.conditions for each in condition.library.own)]
    with held_sweep(output, reads) as directory:
        task = task_of(file, directory)
        for condition in file.conditions:
            for warning in (*condition.config.warnings, *sensors_left_aside(condition.config)):
                say(f"warning: {condition.name + ': ' if condition.name else ''}{warning}")
        engine = engine_for(task, workers, scheduler)
        with Pace(task) as watcher:
            try:
                outcome = run_sweep(task, directory, engine, watcher)
            except KeyboardInterrupt:
                say(f"{watcher.kept} of {len(task.plan.units)} units are kept in {output}; the same command goes on")
                raise
            watcher.note(f"all files written after {time.monotonic() - watcher.started:.1f} s")
    told(directory, outcome.summary, as_json)
    for failure in outcome.failures[:1]:
        more = f" (and {len(outcome.failures) - 1} more)" if len(outcome.failures) > 1 else ""
        say(f"{failure.name} failed{more}: {failure.reason}; see 'retarder-synth sweep failed {output}'")
    return LIMITS_MISSED if outcome.failures else OK


def engine_for(task: Task, workers: int | None, scheduler: str | None) -> Engine:
    """Processes on this machine as far as memory allows, or the cluster that was named."""
    from synth.retarder.sweep.run import fitting_workers
    from synth.retarder.sweep.unit_answer import answer

    if scheduler is not None:
        from synth.frame.workers.dask_cluster import connect

        cluster = connect(scheduler, answer)
        say(f"the scheduler at {scheduler} has {cluster.threads()} threads of workers; more may join")
        return cluster
    from synth.frame.workers.local_workers import LocalWorkers

    asked = workers or available()
    fit = fitting_workers(task, asked)
    if fit < min(asked, len(task.missing)):
        say(f"warning: memory allows for {fit} of {asked} workers")
    return LocalWorkers(fit, answer)


class Pace:
    """Tells on stderr of every unit, with the rate so far and the time left by the work left; a context manager."""

    def __init__(self, task: Task) -> None:
        from synth.frame.terminal.progress import Progress

        self.started = time.monotonic()
        self._units, self._missing = len(task.plan.units), len(task.missing)
        self._left = sum(unit.work for unit in task.missing)
        self._all = self._left
        self._ended = 0
        self._progress: Progress = Progress(self._missing)

    def __enter__(self) -> Pace:
        self._progress.__enter__()
        there = self._units - self._missing
        if there:
            self.note(f"{there} of {self._units} units are there already")
        return self

    def __exit__(self, *fault: Any) -> None:
        self._progress.__exit__(*fault)

    @property
    def kept(self) -> int:
        """Units that need not be computed again, failed ones of this run among them."""
        return self._units - self._missing + self._ended

    def note(self, sentence: str) -> None:
        """A line of its own."""
        self._progress.note(sentence)

    def done(self, unit: Unit, sentence: str) -> None:
        """A unit is computed, or has failed."""
        self._ended += 1
        self._left -= unit.work
        elapsed = time.monotonic() - self.started
        left = elapsed / (self._all - self._left) * self._left
        rate = f"{elapsed:.0f} s, {60.0 * self._ended / max(elapsed, 1e-3):.0f} units a minute"
        ahead = f", about {left:.0f} s left" if left > 0.5 else ""
        self.note(f"[{self._ended:{len(str(self._missing))}}/{self._missing}] {sentence}; {rate}{ahead}")


def told(directory: SweepDirectory, summary: dict[str, Any], as_json: bool) -> None:
    """The end of a run on stdout."""
    if as_json:
        sys.stdout.write(directory.summary.read_text(encoding="utf-8"))
        return
    from synth.frame.terminal.printed_page import print_page

    page = []
    for each in summary["conditions"]:
        folder = directory.book_folder(each["name"] or "")
        if not each["tables"]:
            page.append(f"{folder}: no table; all {each['classes']} classes failed")
            continue
        page.append(
            f"{folder / 'book.h5'}: {each['tables']} tables of {each['classes'] - each['failed']} classes; rms median "
            f"{each['median_rms_m_s']:.3f}, highest {each['highest_rms_m_s']:.3f} m/s; {each['missing_a_limit']} "
            "miss a limit of [acceptance]"
        )
        if each["refused_targets"]:
            page.append(f"  targets without a table: {each['refused_targets']}; see 'retarder-synth sweep failed'")
        if each["highest_interpolation_loss_m_s"] is not None:
            loss_mm_s = 1e3 * each["highest_interpolation_loss_m_s"]
            page.append(f"  lines between two tables lose at most {loss_mm_s:.2f} mm/s")
        if each["shadowed_tables"]:
            page.append(
                f"  {each['shadowed_tables']} tables are not reached by a choice by category and axles alone: it takes "
                "the heaviest class"
            )
        if each["no_controller_code"]:
            page.append(f"  the book makes no controller code: {each['no_controller_code']}")
    print_page(*page)


def status_command(path: Path, as_json: bool) -> int:
    """Print how far a sweep is."""
    import json
    from dataclasses import asdict

    from synth.frame.terminal.printed_page import print_page
    from synth.retarder.sweep.status import status_of

    status = status_of(path)
    if as_json:
        print(json.dumps({**asdict(status), "path": str(path)}, indent=1, ensure_ascii=False))
        return OK
    state = "running" if status.running else "complete" if status.complete else "not running, not complete"
    refused = f", targets without a table: {status.refused_targets}" if status.refused_targets else ""
    page = [
        f"{path}: {status.title}: {state}; {status.done} of {status.units} units done, {status.failed} failed{refused}"
    ]
    if status.rate_units_per_min is not None and status.remaining_s is not None:
        page.append(f"  {status.rate_units_per_min:.1f} units a minute, about {status.remaining_s:.0f} s left")
    if status.in_flight:
        page.append(f"  under way: {', '.join(status.in_flight)}")
    if status.bad_ledger_lines:
        page.append(f"  {status.bad_ledger_lines} lines of the ledger are torn or damaged and were passed over")
    print_page(*page)
    return OK


def failed_command(path: Path, as_json: bool) -> int:
    """Print the units that have failed and the targets without a table, with the reason."""
    import json
    from dataclasses import asdict

    from synth.frame.terminal.printed_page import print_page
    from synth.retarder.sweep.status import failed_units

    found = failed_units(path)
    if as_json:
        print(json.dumps([asdict(unit) for unit in found], indent=1, ensure_ascii=False))
        return OK
    print_page(*(f"{unit.name}: {unit.reason}" for unit in found))
    if not found:
        print_page(f"{path}: no unit has failed")
    return OK
