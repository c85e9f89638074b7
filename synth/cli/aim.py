"""`retarder-synth aim`: everything that can be refused is refused before anything is computed or written."""

from __future__ import annotations

import sys
import time
from pathlib import Path
from typing import TYPE_CHECKING

from synth.frame.terminal.telling import LIMITS_MISSED, OK, say

if TYPE_CHECKING:
    from synth.frame.results_directory import ResultsDirectory
    from synth.yard.aim.resolved_aim import ResolvedAim


def aim_command(path: Path | None, output: Path, passes: int | None, seed: int | None, as_json: bool) -> int:
    """Make the aim tables of the configuration in `path` in the directory `output`; the exit code."""
    from synth.configuration.aim.aim_file import read_aim_file
    from synth.frame.creation_time import require_date
    from synth.frame.results_directory import results_directory

    file = read_aim_file(path).with_simulation(passes, seed)
    require_date()
    from synth.yard.aim.aimed_position import position_of
    from synth.yard.aim.resolved_aim import resolve_aim

    config = resolve_aim(file)
    position_of(config)  # refuses a book that does not fit
    with results_directory(output, "aim", filter(None, [path])) as directory:
        for warning in config.warnings:
            say(f"warning: {warning}")
        return aim_into(directory, config, as_json)


def aim_into(directory: ResultsDirectory, config: ResolvedAim, as_json: bool) -> int:
    """The work itself, and what is said about it."""
    from synth.frame.creation_time import creation_time
    from synth.frame.terminal.interrupt import interruptible
    from synth.frame.terminal.progress import Progress
    from synth.kernels.cache import cache_in_use, guarded
    from synth.present.aim_outputs import write_aim
    from synth.yard.aim.aim_acceptance import judge_aims
    from synth.yard.aim.aim_book import aim_book

    started = time.monotonic()
    cache = cache_in_use()
    with interruptible(directory, "summary"), Progress(len(config.members), "aiming", "categories") as progress:
        if cache is None or next(cache.rglob("*.nbi"), None) is None:
            progress.note("compiling the kernels for this machine, once; this takes some seconds")
        book = guarded(aim_book, config, creation_time(), progress.done)
        progress.note(f"{len(book.tables)} tables computed in {time.monotonic() - started:.1f} s")
        verdict = judge_aims(book.tables, config.acceptance.p_excess)
        write_aim(book, verdict, directory, progress.note)
        progress.note(f"all files written after {time.monotonic() - started:.1f} s")
    if as_json:
        sys.stdout.write((directory.path / "summary.json").read_text(encoding="utf-8"))
    else:
        from synth.cli.aim_summary_table import print_aims

        print_aims(book, verdict, directory.path)
    return OK if verdict.accepted else LIMITS_MISSED
