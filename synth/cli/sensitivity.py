"""`retarder-synth sensitivity`: everything that can be refused is refused before anything is computed or written."""

from __future__ import annotations

import sys
import time
from pathlib import Path
from typing import TYPE_CHECKING

from synth.cli import OK, say
from synth.cli.processors import available
from synth.cli.tables_refused import tables_refused

if TYPE_CHECKING:
    from collections.abc import Callable

    from synth.book.sensitivity.fixed_tables import FixedTables
    from synth.book.sensitivity.sensitivity import Sensitivity, Trial
    from synth.configuration.resolved_config import ResolvedConfig


def sensitivity_command(
    path: Path | None, table: Path | None, output: Path, numbers: tuple[int, int, int | None], as_json: bool
) -> int:
    """Share out the variance of the exits of tables on the plants of `path`; `numbers`: points, passes and seed."""
    from synth.book.creation_time import creation_time, require_date
    from synth.book.forms.table_file import files_at
    from synth.book.sensitivity.fixed_tables import tables_in
    from synth.book.sensitivity.sensitivity import Trial
    from synth.cli.interrupt import interruptible
    from synth.cli.progress import Progress
    from synth.configuration.config_file import BUILT_IN, load_config
    from synth.frame.results_directory import results_directory
    from synth.kernels.cache import guarded

    config, source = load_config(path), str(path or BUILT_IN)
    given = None if table is None else tables_in(table, config, source)
    require_date()
    points, passes, seed = numbers
    trial = Trial(points, passes, config.validation.seed if seed is None else seed)
    started, created = time.monotonic(), creation_time()
    reads = [*filter(None, [path]), *([] if table is None else files_at(table))]
    with results_directory(output, "sensitivity", reads) as directory:
        for warning in config.warnings:
            say(f"warning: {warning}")
        steps = len(given) if given else 2 * len(config.cuts)
        with interruptible(directory, "summary"), Progress(steps, "simulating", "steps") as progress:
            from synth.present.sensitivity_outputs import DOCUMENT, write_sensitivity

            found = guarded(shared_out, config, source, given, created, trial, progress.done)
            write_sensitivity(found, created, directory)
            progress.note(f"all files written after {time.monotonic() - started:.1f} s")
    if as_json:
        sys.stdout.write((output / DOCUMENT).read_text(encoding="utf-8"))
    else:
        print_found(found, output)
    return OK


def shared_out(
    config: ResolvedConfig,
    source: str,
    given: tuple[FixedTables, ...] | None,
    created: str,
    trial: Trial,
    tell: Callable[[str], None],
) -> Sensitivity:
    """Tune the tables unless they are `given`, and let the plant vary under them."""
    from synth.book.sensitivity.fixed_tables import tables_tuned
    from synth.book.sensitivity.sensitivity import sensitivity

    with tables_refused(source, config):
        fixed = given or tables_tuned(config, created, min(len(config.cuts), available()), tell)
        return sensitivity(config, fixed, trial, available(), tell)


def print_found(found: Sensitivity, directory: Path) -> None:
    """What to measure first, by output, and where the files are."""
    from synth.book.sensitivity.ranking import UNDECIDABLE, measure_first, percent
    from synth.cli.printed_page import print_page

    trial = found.trial
    page = [f"mean over {len(found.cases)} tables, each on {trial.points} plants with {trial.passes} passes:"]
    for each in found.overall:
        page.append(measure_first(found.names, each))
        if each.varies:
            open_ones = sum(not share.decided for share in each.shares)
            page.append(
                f"  parameters together {percent(each.together)}, noise of the passes {100.0 * each.noise.value:.1f} %"
                f"; {open_ones} of {len(found.keys)} parameters {UNDECIDABLE}"
            )
    output = found.config.output
    print_page(
        *page,
        f"{directory}: {'plots/, ' * output.plots}{'report.html, ' * output.report}sensitivity.csv, sensitivity.json, "
        "summary.json",
    )
