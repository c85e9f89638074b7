"""The tables that stay as they are while the plant under them varies: tuned here, or read from a file."""

from __future__ import annotations

from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path

from plant_models import Plant
from synth.frame.printed_numbers import counted
from synth.frame.workers.engine import Tell
from synth.retarder.class_setup import class_setup, origin_of, validation_passes
from synth.retarder.configuration.cut_class import CutClass
from synth.retarder.configuration.resolved_config import ResolvedConfig
from synth.retarder.forms.tables_at import tables_at
from synth.retarder.served_class import plant_for
from synth.retarder.tuned_table import solutions, tuned_table
from synth.solver.one_blas_thread import one_blas_thread
from tuning_tables import ControllerTable


@dataclass(frozen=True)
class FixedTables:
    """The tables of one class, in the order of their targets, and its nominal plant."""

    cut_class: CutClass
    plant: Plant
    tables: tuple[ControllerTable, ...]


def tables_in(path: Path, config: ResolvedConfig, source: str) -> tuple[FixedTables, ...]:
    """The tables in `path` with the classes of `config` that they fit; `InputError` where there is none."""
    tables = tables_at(path).only_lines("sensitivity --table")
    labels = [plant_for(table, config, source)[0] for table in tables]
    found = []
    for cut_class in config.cuts:
        own = [table for table, label in zip(tables, labels, strict=True) if label == cut_class.label]
        if own:
            ordered = tuple(sorted(own, key=lambda table: table.target_speed_m_s))
            found.append(FixedTables(cut_class, config.plant_of(cut_class), ordered))
    return tuple(found)


@one_blas_thread()
def tables_tuned(config: ResolvedConfig, created: str, workers: int, tell: Tell) -> tuple[FixedTables, ...]:
    """The tables that a tune of `config` makes: the same lines, to the bit."""

    def of(cut_class: CutClass) -> FixedTables:
        plant = config.plant_of(cut_class)
        origin = origin_of(config.sha256, created)
        setup = class_setup(config, cut_class.label, plant, validation_passes(config).part(0, 1), origin)
        found = solutions(setup.design, config.aims_of(cut_class.label))
        tables = tuple(tuned_table(setup, solution).table for solution in found)
        tell(f"{cut_class.label}: {counted(len(tables), 'table')} tuned")
        return FixedTables(cut_class, plant, tables)

    with ThreadPoolExecutor(max_workers=workers) as pool:
        return tuple(pool.map(of, config.cuts))
