"""What `retarder-synth inspect -o DIR` leaves: pictures of tables, and a page of what it tells."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from synth.frame.input_error import InputError
from synth.frame.printed_numbers import counted
from synth.frame.terminal.manner import Manner

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from synth.frame.results_directory import ResultsDirectory
    from synth.frame.terminal.printed_page import Printed
    from synth.retarder.forms.tables_at import TablesAt


@dataclass(frozen=True)
class AskedDrawing:
    """Where the pictures go, and the configuration that was named."""

    output: Path
    config: Path | None


@dataclass(frozen=True)
class Drawn:
    """The pictures that were written into `output`."""

    output: Path
    files: tuple[str, ...]

    def document(self) -> dict[str, Any]:
        """The same for programs."""
        return {"pictures": list(self.files)}

    def page(self) -> Iterator[Printed]:
        """The same in words."""
        yield f"{counted(len(self.files), 'picture')} and report.html in {self.output}"


def asked_drawing(output: Path | None, config: Path | None) -> AskedDrawing | None:
    """As it was typed; None where nothing is to be drawn. `InputError`."""
    if output is not None:
        return AskedDrawing(output, config)
    if config is not None:
        raise InputError("inspect --config is about pictures; name a folder for them by -o")
    return None


def draw(source: Path, tables: TablesAt, asked: AskedDrawing, page: Sequence[Printed], manner: Manner) -> Drawn:
    """Draw the `tables` at `source`, passes only for those that a class of the configuration fits; and leave `page`."""
    from synth.aim.pictures.commands import aim_figures
    from synth.cli.inspect_pictures import Surroundings, figures_of
    from synth.cli.printed_report import report_of
    from synth.frame.perform import PAGE
    from synth.frame.results_directory import results_directory
    from synth.frame.terminal.interrupt import interruptible
    from synth.retarder.forms.table_file import file_stem, files_at
    from synth.retarder.tables_configuration import configuration_for

    config, place = configuration_for(asked.config, source, tables.of_stages)
    around = Surroundings(config, place, asked.config is not None, manner)
    reads = [*files_at(source), *filter(None, [asked.config])]
    with results_directory(asked.output, "inspect", reads) as directory, interruptible(directory, "pictures"):
        files = [*written(directory, aim_figures([file.table for file in tables.aims]))]
        for table in tables.of_stages:
            stem = file_stem(table)
            files += written(directory, {f"{stem}-{name}": each for name, each in figures_of(table, around).items()})
            manner.step(f"drawn: {table.id}")
        directory.write(PAGE, report_of(f"Contents of {source.name}", page))
    return Drawn(asked.output, tuple(files))


def written(directory: ResultsDirectory, figures: Mapping[str, Figure]) -> list[str]:
    """The names of the files of `figures`, written."""
    from synth.frame.picture.figure_file import figure_files

    files = (directory.write_all(figure_files(figure, name)) for name, figure in figures.items())
    return [str(file) for several in files for file in several]
