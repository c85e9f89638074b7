"""What `retarder-synth inspect -o DIR` leaves: pictures of tables, and a page of what it tells. Nothing is solved."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar

from synth.frame.faults import InputError
from synth.frame.printed_numbers import counted
from synth.frame.terminal.manner import Manner

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from synth.frame.results_directory import ResultsDirectory
    from synth.frame.terminal.printed_page import Printed
    from synth.retarder.configuration.resolved_config import ResolvedConfig
    from synth.retarder.forms.tables_at import TablesAt
    from tuning_tables import ControllerTable
    from tuning_tables.document import StageTable
    from tuning_tables.passages.passage_table import PassageTable

Simulated = TypeVar("Simulated")


@dataclass(frozen=True)
class Surroundings:
    """The configuration that passes are simulated by, what messages call it, and whether the user `asked` for it."""

    config: ResolvedConfig
    place: str
    asked: bool
    manner: Manner

    def passes(self, simulate: Callable[[], Simulated]) -> Simulated | None:
        """What `simulate` gives; None, with a word why, where no class fits and no configuration was asked for."""
        from synth.frame.faults import InputError
        from synth.kernels.cache import guarded

        try:
            return guarded(simulate)
        except InputError as fault:
            if self.asked:
                raise
            self.manner.warn(f"no passes are drawn: {fault}")
            return None


def figures_of(table: StageTable, around: Surroundings) -> Mapping[str, Figure]:
    """The pictures of a table by the end of their names."""
    from tuning_tables.passages.passage_table import PassageTable

    return passage_figures(table, around) if isinstance(table, PassageTable) else line_figures(table, around)


def line_figures(table: ControllerTable, around: Surroundings) -> Mapping[str, Figure]:
    """The pictures of a table with lines by the end of their names."""
    from synth.retarder.pictures.table_picture import Passes, drawn_passes, table_lines, table_passes, table_surfaces
    from synth.retarder.served_class import plant_for

    def simulate() -> Passes:
        plant = plant_for(table, around.config, around.place)[1]
        return drawn_passes(table, plant, around.config.validation.seed)

    passes = around.passes(simulate)
    figures = {"lines": table_lines(table, passes), "surfaces": table_surfaces(table, passes)}
    return figures if passes is None else {**figures, "passes": table_passes(table, passes)}


def passage_figures(table: PassageTable, around: Surroundings) -> Mapping[str, Figure]:
    """The pictures of a table for point sensors by the end of their names."""
    from synth.retarder.pictures.table_picture import subject
    from synth.retarder.sensors.sensor_case import sensor_passes
    from synth.retarder.sensors.table_pictures import passes_figure, switching_speeds
    from synth.retarder.served_class import served_class
    from synth.simulation.passage_controller import PassageTrace, of_table
    from synth.simulation.passes import TRACE_FACTORS
    from synth.simulation.stratified_passes import stratified_passes

    def simulate() -> tuple[PassageTrace, ...]:
        served = served_class(table, around.config, around.place)
        few = stratified_passes(around.config.validation.seed, 0, len(TRACE_FACTORS))
        passes = sensor_passes(served.plant, served.sensors, few, len(table.pressure_kpa))
        return tuple(passes.trace(of_table(table, tracking=True), i, factor) for i, factor in enumerate(TRACE_FACTORS))

    traces = around.passes(simulate)
    figures = {"switching-speeds": switching_speeds(subject(table), [table], [traces or ()])}
    if traces is None:
        return figures
    return {**figures, "passes": passes_figure(subject(table), table, traces)}


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
    from synth.aim.pictures import aim_figures
    from synth.cli.printed_report import report_of
    from synth.frame.perform import PAGE
    from synth.frame.results_directory import results_directory
    from synth.frame.terminal.interrupt import interruptible
    from synth.retarder.configured import configuration_for
    from synth.retarder.forms.tables_at import file_stem, files_at

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
    from synth.frame.picture.house_style import figure_files

    files = (directory.write_all(figure_files(figure, name)) for name, figure in figures.items())
    return [str(file) for several in files for file in several]
