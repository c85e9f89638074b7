"""`retarder-synth permissions`: what can be refused is refused before anything is computed or written."""

from __future__ import annotations

import sys
import time
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from synth.cli import OK, say
from synth.cli.tables_refused import tables_refused

if TYPE_CHECKING:
    from synth.book.permissions.permission import CasePermissions, Permission


def permissions_command(path: Path | None, output: Path, workers: int, as_json: bool) -> int:
    """Tell what permissions of the hardware would give in every case of `path`; the exit code."""
    from synth.book.creation_time import creation_time, require_date
    from synth.book.permissions.refusal import require_tellable
    from synth.cli.interrupt import interruptible
    from synth.cli.progress import Progress
    from synth.cli.tune import require_room, sensors_left_aside
    from synth.configuration.config_file import BUILT_IN, load_config
    from synth.frame.results_directory import SUMMARY, results_directory
    from synth.kernels.cache import guarded

    config, source = load_config(path), str(path or BUILT_IN)
    require_tellable(config, source, "permissions")
    require_room(config, path, workers)
    require_date()
    started, created = time.monotonic(), creation_time()
    with results_directory(output, "permissions", filter(None, [path])) as directory:
        for warning in (*config.warnings, *sensors_left_aside(config)):
            say(f"warning: {warning}")
        with interruptible(directory, "summary"), Progress(len(config.problems()), "comparing") as progress:
            from synth.book.permissions.case_permissions import permissions_of
            from synth.present.permissions_outputs import write_permissions

            with tables_refused(source):
                cases = guarded(permissions_of, config, created, workers, progress.done)
            write_permissions(config, cases, created, directory)
            progress.note(f"all files written after {time.monotonic() - started:.1f} s")
    if as_json:
        sys.stdout.write((output / SUMMARY).read_text(encoding="utf-8"))
    else:
        print_permissions(cases, output)
    return OK


def print_permissions(cases: Sequence[CasePermissions], directory: Path) -> None:
    """A table with a row for each case and a column for each permission."""
    from synth.book.permissions.overview import asked_of, medians
    from synth.book.printed_numbers import plus_minus
    from synth.cli.printed_page import print_page
    from synth.cli.printed_table import Column, PrintedTable

    def column(permission: Permission) -> Column[CasePermissions]:
        def cell(case: CasePermissions) -> str | None:
            found = case.of(permission)
            return None if found is None else plus_minus(found.ratio, found.ratio_ci95)

        return Column(permission.value, cell, spare=1)

    columns: tuple[Column[CasePermissions], ...] = (
        Column("case", lambda case: case.label, words=True, once=True),
        Column("target, m/s", lambda case: f"{case.target_speed_m_s:g}"),
        Column(
            "rms as configured, m/s", lambda case: plus_minus(case.table.rms_m_s, case.table.rms_ci95_m_s, 4), spare=2
        ),
        *map(column, asked_of(cases)),
    )
    print_page(
        PrintedTable(columns, cases, "summary.json"),
        f"{cases[0].table.passes} stratified passes a case. Columns of permissions: rms over that of the table as "
        f"configured, on the same passes, ± 95 %. Medians: {medians(cases)}.",
        f"{directory}: plots/, summary.json",
    )
