"""`retarder-synth replay`: measured passes under other tables; refused is what can be before anything runs."""

from __future__ import annotations

import sys
from collections.abc import Sequence
from pathlib import Path

from synth.book.tables_refused import require_a_table, tables_refused
from synth.frame.processors import available
from synth.frame.terminal.telling import LIMITS_MISSED, OK, say


def replay_command(
    logs: Sequence[Path], tables: Path, own: Path | None, mapping: Path | None, config_path: Path | None,
    output: Path, as_json: bool,
) -> int:  # fmt: skip
    """Run the passes in `logs` again under `tables`; 1 where the configuration does not describe the log."""
    from synth.book.forms.table_file import read_tables
    from synth.book.watcher import Teller
    from synth.configuration.config_file import BUILT_IN, load_config
    from synth.frame.creation_time import creation_time, require_date
    from synth.frame.results_directory import results_directory
    from synth.frame.terminal.interrupt import interruptible
    from synth.kernels.cache import guarded
    from synth.yard.measured_passes.loaded_passes import loaded_passes

    config, source = load_config(config_path), str(config_path or BUILT_IN)
    (other,) = read_tables(tables)
    drove = None if own is None else read_tables(own)[0].tables
    require_date()
    passes = loaded_passes(logs, mapping, config, source, lambda sentence: say(f"warning: {sentence}"))
    from synth.present.measured_outputs import write_replay
    from synth.yard.measured_passes.replay.replay import ReplayOrder, replay
    from synth.yard.measured_passes.replay.replay_summary import is_described, replay_sentences
    from synth.yard.measured_passes.retune.tuned_books import class_setups, tables_by_case, tuned_tables

    tables_by_case(other.tables, config, source)  # refused where one fits no class
    created = creation_time()
    reads = [*logs, tables, *filter(None, (own, mapping, config_path))]
    with results_directory(output, "replay", reads) as directory, interruptible(directory, "summary"):
        if drove is None:
            setups = class_setups(config, created)
            with tables_refused(source, config):
                made = guarded(tuned_tables, config, setups, available(), Teller(lambda _: None))
                require_a_table(tuple(made.tables), made.failed)
            for case in made.failed:
                say(f"warning: {case.sentence}")
            drove = tuple(made.tables.values())
        found = guarded(replay, passes, config, ReplayOrder(drove, other.tables))
        write_replay(found, config, created, directory)
    if as_json:
        sys.stdout.write((output / "summary.json").read_text(encoding="utf-8"))
    else:
        from synth.frame.terminal.printed_page import print_page

        print_page(*replay_sentences(found), f"{output}: plots/, report.html, summary.json")
    return OK if is_described(found) else LIMITS_MISSED
