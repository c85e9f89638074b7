"""`retarder-synth retune`: new tables from measured passes, refused where they are within noise."""

from __future__ import annotations

import sys
from collections.abc import Sequence
from pathlib import Path

from synth.book.tables_refused import tables_refused
from synth.frame.processors import available
from synth.frame.terminal.telling import LIMITS_MISSED, OK, say


def retune_command(
    logs: Sequence[Path], tables: Path | None, mapping: Path | None, config_path: Path | None, output: Path,
    as_json: bool,
) -> int:  # fmt: skip
    """Tune tables for what `logs` say; 1 where none is better beyond doubt than the old ones, or a case has none."""
    from synth.book.forms.table_file import read_tables
    from synth.frame.creation_time import creation_time, require_date
    from synth.frame.results_directory import results_directory
    from synth.frame.terminal.interrupt import interruptible
    from synth.frame.terminal.progress import Progress
    from synth.kernels.cache import guarded
    from synth.yard.measured_passes.config_source import config_source
    from synth.yard.measured_passes.loaded_passes import loaded_passes

    source = config_source(config_path)
    config = source.resolved()
    given = None if tables is None else read_tables(tables)[0].tables
    require_date()
    passes = loaded_passes(logs, mapping, config, source.place, lambda sentence: say(f"warning: {sentence}"))
    from synth.present.measured_outputs import write_retune
    from synth.yard.measured_passes.retune.retune import RetuneOrder, retune
    from synth.yard.measured_passes.retune.retune_summary import retune_sentences
    from synth.yard.measured_passes.retune.tuned_books import tables_by_case

    old = None if given is None else tables_by_case(given, config, source.place)
    reads = [*logs, *filter(None, (tables, mapping, config_path))]
    with (
        results_directory(output, "retune", reads) as directory,
        interruptible(directory),
        Progress(len(config.problems())) as progress,
    ):
        order = RetuneOrder(old, creation_time(), threads=available())
        with tables_refused(source.place, config):
            found = guarded(retune, passes, source, order, progress)
        write_retune(found, directory)
    if as_json:
        sys.stdout.write((output / "summary.json").read_text(encoding="utf-8"))
    else:
        from synth.frame.terminal.printed_page import print_page

        files = ("tables/, book.h5, " if found.tables else "") + "plots/, report.html, summary.json"
        print_page(*retune_sentences(found), f"{output}: {files}")
    return OK if found.changed and not found.failed else LIMITS_MISSED
