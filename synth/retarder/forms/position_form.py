"""The position that tables were made for, as a unit of FMI 3.0: of the configuration that lies beside them."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from plant_models import Plant, PlantError
from synth.frame.input_error import InputError
from synth.frame.terminal.telling import say
from synth.retarder.configuration.config_file import parse_config
from synth.retarder.fmi.compiler import compiler, platform
from synth.retarder.fmi.position_unit import position_unit
from synth.retarder.forms.configuration_beside import kept_configuration
from synth.retarder.forms.table_forms import Files
from synth.retarder.served_class import plant_for
from tuning_tables.export_prefix import ExportPrefix
from tuning_tables.table_kinds import AnyTable, StageTable


def position_files(source: Path, tables: Sequence[AnyTable], prefix: ExportPrefix) -> Files:
    """The unit of the position, by the name of its file; what it lacks, or why there is none, is said in a sentence.

    `source`, `tables`: as of `configuration_file`, tables with lines or for point sensors.
    """
    if compiler() is None or platform() is None:
        say("no library is made on this machine, for want of a C compiler or of Linux: the units hold sources alone")
    try:
        plants = plants_of(source, [table for table in tables if isinstance(table, StageTable)])
        generator = tables[0].generator
        unit = position_unit(plants, f"{generator.name} {generator.version}", prefix)
    except (InputError, PlantError) as fault:
        say(f"the position is not exported: {fault}")
        return {}
    return {f"{unit.identifier}.fmu": unit.archive()}


def plants_of(source: Path, tables: Sequence[StageTable]) -> list[Plant]:
    """The plants of the configuration, that of the first table first; `InputError` where there is none for it."""
    kept = kept_configuration(source, tables)
    if kept is None:
        raise InputError(f"{source}: the configuration of the tables is not beside them; give the directory of a tune")
    path, content = kept
    config = parse_config(content.decode(), str(path))
    first = plant_for(tables[0], config, str(path))[1]
    return [first, *(plant for _, plant in config.plants())]
