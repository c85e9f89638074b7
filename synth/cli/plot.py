"""`retarder-synth plot`: pictures of exported tables; nothing is solved."""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, TypeVar

from synth.frame.terminal.telling import say

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from synth.retarder.configuration.resolved_config import ResolvedConfig
    from tuning_tables import ControllerTable
    from tuning_tables.aim import AimTable
    from tuning_tables.passages.passage_table import PassageTable
    from tuning_tables.table_kinds import StageTable

Drawn = TypeVar("Drawn")


def plot_command(source: Path, output: Path, config_path: Path | None, as_json: bool) -> int:
    """Draw the tables in `source` into `output`; passes only for tables that a class of the configuration fits."""
    from synth.frame.results_directory import results_directory
    from synth.frame.terminal.interrupt import interruptible
    from synth.retarder.forms.aim_file import read_aims
    from synth.retarder.forms.any_tables import any_tables
    from synth.retarder.forms.table_file import file_stem, files_at, holds_tables
    from synth.retarder.tables_configuration import configuration_for
    from tuning_tables.passages.passage_table import PassageTable

    aims = [file.table for file in read_aims(source)]
    tables = any_tables(source) if not aims or holds_tables(source) else []
    config, place = configuration_for(config_path, [table for table in tables if isinstance(table, PassageTable)])
    around = Surroundings(config, place, config_path is not None)
    from synth.frame.picture.figure_file import figure_files

    written: list[str] = []
    reads = [*files_at(source), *filter(None, [config_path])]
    with results_directory(output, "plot", reads) as directory, interruptible(directory, "pictures"):
        for name, figure in aim_figures(aims).items():
            written += map(str, directory.write_all(figure_files(figure, name)))
        for table in tables:
            for name, figure in figures_of(table, around).items():
                written += map(str, directory.write_all(figure_files(figure, f"{file_stem(table)}-{name}")))
    print(json.dumps({"files": written}, indent=1, ensure_ascii=False) if as_json else "\n".join(written))
    return 0


@dataclass(frozen=True)
class Surroundings:
    """The configuration that passes are simulated by, what messages call it, and whether the user `asked` for it."""

    config: ResolvedConfig
    place: str
    asked: bool

    def passes(self, simulate: Callable[[], Drawn]) -> Drawn | None:
        """What `simulate` gives; None, with a word why, where no class fits and no configuration was asked for."""
        from synth.frame.input_error import InputError
        from synth.kernels.cache import guarded

        try:
            return guarded(simulate)
        except InputError as fault:
            if self.asked:
                raise
            say(f"no passes are drawn: {fault}")
            return None


def aim_figures(tables: Sequence[AimTable]) -> Mapping[str, Figure]:
    """The pictures of aim tables by name, all tables of one kind of knowledge together."""
    from synth.aim.pictures.commands import commands_by_cars, commands_by_resistance

    measured = [table for table in tables if table.is_measured]
    plain = [table for table in tables if not table.is_measured]
    found = {"aim-commands-by-cars": commands_by_cars(plain)} if plain else {}
    return {**found, "aim-commands-by-resistance": commands_by_resistance(measured)} if measured else found


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
    from synth.retarder.sensors.pictures.passes_with_readings import passes_figure
    from synth.retarder.sensors.pictures.switching_speeds import switching_speeds
    from synth.retarder.sensors.sensor_class import sensor_passes
    from synth.retarder.served_class import served_class
    from synth.simulation.passage_controller import of_table
    from synth.simulation.passage_sample import PassageTrace
    from synth.simulation.passes import TRACE_FACTORS
    from synth.simulation.stratified_passes import stratified_passes

    def simulate() -> tuple[PassageTrace, ...]:
        served = served_class(table, around.config, around.place)
        few = stratified_passes(around.config.validation.seed, 0, len(TRACE_FACTORS))
        passes = sensor_passes(served.plant, served.sensors, few)
        return tuple(passes.trace(of_table(table, tracking=True), i, factor) for i, factor in enumerate(TRACE_FACTORS))

    traces = around.passes(simulate)
    figures = {"switching-speeds": switching_speeds(subject(table), [table], [traces or ()])}
    if traces is None:
        return figures
    return {**figures, "passes": passes_figure(subject(table), table, traces)}
