"""`retarder-synth sensors plan`: what can be refused is refused before anything is computed or written."""

from __future__ import annotations

import sys
import time
from pathlib import Path

from synth.cli import LIMITS_MISSED, OK, say
from synth.frame.input_error import InputError

FEWEST, MOST = 2, 24


def sensors_plan_command(
    source: Path | None, output: Path, sensors: str, rms_m_s: float | None, workers: int, as_json: bool
) -> int:
    """Plan the point sensors of `source` into the directory `output`; the exit code."""
    from synth.book.creation_time import creation_time, require_date
    from synth.configuration.config_file import load_config
    from synth.frame.results_directory import results_directory

    config = load_config(source)
    numbers = numbers_of(sensors)
    require_date()
    from synth.book.sensors.layout_order import layout_problem
    from synth.book.sensors.layout_results import layout_results
    from synth.present.sensor_plan_outputs import write_sensor_plan

    problem, labels = layout_problem(config)
    started = time.monotonic()
    with results_directory(output, "sensors plan", filter(None, [source])) as directory:
        for warning in config.warnings:
            say(f"warning: {warning}")
        results = layout_results(problem, labels, numbers, rms_m_s, workers, say)
        write_sensor_plan(results, config.sha256, creation_time(), directory, config.output.plots)
        say(f"all files written after {time.monotonic() - started:.1f} s")
    if as_json:
        sys.stdout.write((output / "summary.json").read_text(encoding="utf-8"))
    else:
        from synth.cli.sensors_plan_table import print_plan

        print_plan(results, output)
    return OK if results.chosen is not None else LIMITS_MISSED


def numbers_of(word: str) -> tuple[int, ...]:
    """'2-12' or '4,6,8' as rising numbers of sensors; `InputError` for anything else."""
    fault = InputError(
        f"--sensors is {word!r}; give numbers of sensors from {FEWEST} to {MOST}, as 2-12 or 4,6,8: the one behind the "
        "exit counts"
    )
    try:
        ends = [int(part) for part in word.split("-")] if "-" in word else []
        numbers = list(range(ends[0], ends[1] + 1)) if len(ends) == 2 else [int(part) for part in word.split(",")]
    except ValueError:
        raise fault from None
    if not numbers or any(not FEWEST <= number <= MOST for number in numbers):
        raise fault
    return tuple(sorted(set(numbers)))
