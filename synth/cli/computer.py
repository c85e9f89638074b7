"""`retarder-synth computer`: everything that can be refused is refused before anything is computed or written."""

from __future__ import annotations

import sys
import time
from pathlib import Path

from synth.cli import LIMITS_MISSED, OK, say


def computer_command(source: Path | None, output: Path, draws: int | None, seed: int | None, as_json: bool) -> int:
    """Size, judge and price the control computer of `source` into the directory `output`; the exit code."""
    from synth.book.creation_time import creation_time, require_date
    from synth.cli.interrupt import interruptible
    from synth.cli.progress import Progress
    from synth.configuration.computer.computer_file import read_computer_file
    from synth.frame.results_directory import results_directory

    file = read_computer_file(source).with_uncertainty(draws, seed)
    require_date()
    from synth.configuration.plant_fault import in_file
    from synth.present.computer_outputs import write_computer
    from synth.yard.control_computer.computer_acceptance import judge_computer
    from synth.yard.control_computer.computer_results import PARTS, computer_results
    from synth.yard.control_computer.resolved_computer import resolve_computer

    config = resolve_computer(file)
    started = time.monotonic()
    with results_directory(output, "computer", filter(None, [source])) as directory:
        for warning in config.warnings:
            say(f"warning: {warning}")
        with interruptible(directory, "summary"), Progress(PARTS, "computing", "parts") as progress:
            with in_file(config.place, lambda sentence: sentence):
                results = computer_results(config, progress.done)
            verdict = judge_computer(results)
            write_computer(results, verdict, creation_time(), directory, progress.note)
            progress.note(f"all files written after {time.monotonic() - started:.1f} s")
    if as_json:
        sys.stdout.write((output / "summary.json").read_text(encoding="utf-8"))
    else:
        from synth.cli.computer_table import print_computer

        print_computer(results, verdict, output)
    return OK if verdict.accepted else LIMITS_MISSED
