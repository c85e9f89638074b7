"""The position that tables were made for, as a unit of FMI: of the configuration that they were made of."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path

from plant_models import Plant, PlantError
from synth.frame.input_error import InputError
from synth.retarder.fmi.compiler import compiler, platform
from synth.retarder.fmi.interfaces import Interface
from synth.retarder.fmi.position_unit import position_unit
from synth.retarder.forms.table_forms import Files
from synth.retarder.served_class import plant_for
from synth.retarder.tables_configuration import configuration_for
from tuning_tables.export_prefix import ExportPrefix
from tuning_tables.table_kinds import AnyTable, StageTable


def position_files(
    source: Path, tables: Sequence[AnyTable], interface: Interface, prefix: ExportPrefix, warn: Callable[[str], None]
) -> Files:
    """The unit of the position, by the name of its file; `warn` is told in a sentence what is missing, and why.

    `tables`: those at `source`, with lines or for point sensors.
    """
    if compiler() is None or platform() not in interface.folders:
        warn("warning: no library is made without a C compiler, or on this system: the units hold sources alone")
    try:
        plants = plants_of(source, [table for table in tables if isinstance(table, StageTable)])
        unit = position_unit(plants, prefix)
    except (InputError, PlantError) as fault:
        warn(f"warning: the position is not exported: {fault}")
        return {}
    return {f"{unit.identifier}.fmu": unit.archive(interface)}


def plants_of(source: Path, tables: Sequence[StageTable]) -> list[Plant]:
    """The plants of the configuration, that of the first table first; `InputError` unless the tables are made of it."""
    config, place = configuration_for(None, source, tables)
    if config.sha256 not in {table.generator.config_sha256 for table in tables}:
        raise InputError(
            f"{source}: {place} is not the configuration that the tables were made of; give the directory of a tune by "
            "this version"
        )
    first = plant_for(tables[0], config, place)[1]
    return [first, *(plant for _, plant in config.plants())]
