"""The pictures that `retarder-synth inspect` draws of tables; nothing is solved."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, TypeVar

from synth.frame.terminal.manner import Manner

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from synth.retarder.configuration.resolved_config import ResolvedConfig
    from tuning_tables import ControllerTable
    from tuning_tables.passages.passage_table import PassageTable
    from tuning_tables.table_kinds import StageTable

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
        from synth.frame.input_error import InputError
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
        passes = sensor_passes(served.plant, served.sensors, few, len(table.pressure_kpa))
        return tuple(passes.trace(of_table(table, tracking=True), i, factor) for i, factor in enumerate(TRACE_FACTORS))

    traces = around.passes(simulate)
    figures = {"switching-speeds": switching_speeds(subject(table), [table], [traces or ()])}
    if traces is None:
        return figures
    return {**figures, "passes": passes_figure(subject(table), table, traces)}
