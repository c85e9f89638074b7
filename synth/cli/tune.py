"""`retarder-synth tune`: everything that can be refused is refused before anything is computed or written."""

from __future__ import annotations

import sys
import time
from contextlib import ExitStack
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

from synth.book.tables_refused import require_a_table, tables_refused
from synth.configuration.resolved_config import ResolvedConfig
from synth.frame.processors import available
from synth.frame.terminal.telling import LIMITS_MISSED, OK, say

if TYPE_CHECKING:
    from synth.frame.results_directory import ResultsDirectory


def tune_command(
    path: Path | None, output: Path, workers: int | None, permissions: bool, pareto: bool, as_json: bool
) -> int:
    """Tune the configuration in `path` into the directory `output`, and tell what else is asked; the exit code."""
    from synth.book.configured import require_room, sensors_left_aside
    from synth.configuration.config_file import BUILT_IN, load_config
    from synth.frame.creation_time import require_date
    from synth.frame.results_directory import results_directory

    config = load_config(path)
    if permissions:
        from synth.book.permissions.refusal import require_tellable

        require_tellable(config, str(path or BUILT_IN), "--permissions")
    workers = workers or min(len(config.cuts), available())
    require_room(config, str(path or BUILT_IN), workers)
    require_date()
    with results_directory(output, "tune", filter(None, [path])) as directory:
        for warning in (*config.warnings, *sensors_left_aside(config)):
            say(f"warning: {warning}")
        return tune_into(directory, config, path, Asked(workers, permissions, pareto, as_json))


@dataclass(frozen=True)
class Asked:
    """What was asked for on the command line, beside a configuration and a directory."""

    workers: int
    permissions: bool
    pareto: bool
    as_json: bool


def tune_into(directory: ResultsDirectory, config: ResolvedConfig, path: Path | None, asked: Asked) -> int:
    """The work itself, and what is said about it."""
    from synth.frame.terminal.interrupt import interruptible
    from synth.frame.terminal.progress import Progress
    from synth.kernels.cache import cache_in_use, guarded

    started = time.monotonic()
    cache = cache_in_use()
    cases = len(config.problems())
    with interruptible(directory), Progress(cases) as progress, ExitStack() as stack:
        if cache is None or next(cache.rglob("*.nbi"), None) is None:
            progress.note("compiling the kernels for this machine, once; this takes about a minute")
        from synth.present.draw_pictures import Studio

        wanted = config.output.plots or config.output.report
        studio = stack.enter_context(Studio(asked.workers if wanted else 1))
        from synth.book.acceptance import judge
        from synth.book.tune import no_notice, tune
        from synth.frame.printed_numbers import counted
        from synth.present.outputs import store_table, write_outputs

        case_done = studio.case_done if wanted else no_notice
        with tables_refused(str(path or "built-in configuration"), config):
            store = partial(store_table, directory=directory)
            book = guarded(tune, config, store, progress, asked.workers, case_done, asked.permissions, asked.pareto)
            require_a_table(book.cases, book.failed)
            progress.note(f"{counted(len(book.cases), 'case')} computed in {time.monotonic() - started:.1f} s")
            verdict = judge(book.cases, config.acceptance, book.failed)
            summary = write_outputs(book, verdict, directory, studio, progress.note)
        progress.note(f"all files written after {time.monotonic() - started:.1f} s")
    if asked.as_json:
        sys.stdout.write((directory.path / "summary.json").read_text(encoding="utf-8"))
    else:
        from synth.cli.book_table import print_book

        print_book(summary, directory.path, book.permissions, (book.permissions_line, book.pareto_line))
    return OK if verdict.accepted else LIMITS_MISSED
