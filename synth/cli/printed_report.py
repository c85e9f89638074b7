"""What a command prints that only reads, as report.html in a directory of its own."""

from __future__ import annotations

from collections.abc import Sequence
from importlib.metadata import version
from pathlib import Path

from synth.frame.page.document import Stamp
from synth.frame.page.told_page import printed_document
from synth.frame.perform import PAGE
from synth.frame.results_directory import require_own, results_directory
from synth.frame.terminal.printed_page import Printed
from synth.frame.version import creation_time, require_date


def require_place(command: str, output: Path) -> None:
    """`InputError` where `output` shows before any work that a page of `command` cannot go there."""
    require_date()
    if output.is_dir():
        require_own(output, command)


def write_report(
    command: str, title: str, page: Sequence[Printed], source: Path, output: Path, steps: Sequence[str] = ()
) -> None:
    """Write `page` of `command` about `source` into `output`; `InputError` where that is not its own directory."""
    from synth.retarder.forms.tables_at import files_at

    with results_directory(output, command, files_at(source)) as directory:
        directory.write(PAGE, report_of(title, page, steps))


def report_of(title: str, page: Sequence[Printed], steps: Sequence[str] = ()) -> bytes:
    """The page as it is stored."""
    stamp = Stamp(title, creation_time(), version("retarder-synth"))
    return printed_document(stamp, page, steps).encode()
