"""What commands share that are given a configuration, or tables and the configuration that they were made of: reading,
head, and what is refused before any work. Of tables it is the user's configuration, else the copy beside them.
"""

from __future__ import annotations

import hashlib
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final, TypeVar

from plant_models import PlantError
from synth.frame.command import Head
from synth.frame.faults import InputError
from synth.frame.results_directory import CONFIGURATION
from synth.retarder.configuration.resolved_config import ResolvedConfig
from synth.retarder.forms.tables_at import summaries_beside
from tuning_tables.aim.aim_tables import AimTable
from tuning_tables.document import AnyTable
from tuning_tables.export_names import AIM, ExportPrefix

if TYPE_CHECKING:
    from synth.frame.command import Asked
    from synth.retarder.epochs import Epochs
    from synth.retarder.options import TablesOptions
    from tuning_tables.document import StageTable


def head_of(config: ResolvedConfig, warnings: tuple[str, ...] = (), reads: tuple[Path, ...] = ()) -> Head:
    """What is said of `config`, with more warnings, and the other files that are read."""
    return Head(
        title=config.title,
        canonical_json=config.canonical_json(),
        parameters=config.parameters,
        output=config.output,
        warnings=(*config.warnings, *warnings),
        reads=reads,
    )


def sensors_left_aside(config: ResolvedConfig) -> tuple[str, ...]:
    """A word about point sensors in a configuration whose tables are made for a radar."""
    if config.sensors is None:
        return ()
    return ("tables are made for the radar of [sensor]; 'retarder-synth tune' makes those for [sensors]",)


def require_room(config: ResolvedConfig, epochs: Epochs[Any, Any], place: str, workers: int) -> None:
    """`InputError` about the file `place` if the grids of a tune on `epochs` would not fit into memory."""
    from synth.solver.chain.grid import require_memory

    for label, plant in config.plants():
        served, grids = epochs.grids(config, plant)
        try:
            require_memory(label, served, grids, workers)
        except PlantError as error:
            raise InputError(f"{place}: {str(error).replace('grid: ', 'grid.', 1)}") from None


NAME: Final = f"retarder_{CONFIGURATION}"


@dataclass(frozen=True)
class KeptConfiguration:
    """The copy at `path`, as it was written."""

    path: Path
    content: bytes


def configuration_beside(source: Path, tables: Sequence[AnyTable]) -> KeptConfiguration | None:
    """The user's file that the tables were made of; None where no command at `source` kept it.

    `source`: a table, a book, or the directory of a command; what it left lies there, or in a folder above a file. The
    summary must have the hash of the tables' configuration, and that of the copy.
    """
    sha256s = {table.generator.config_sha256 for table in tables}
    for folder, document in summaries_beside(source):
        try:
            is_theirs = document["generator"]["config_sha256"] in sha256s
            content = (folder / CONFIGURATION).read_bytes() if is_theirs else b""
            is_whole = document["files"][CONFIGURATION] == hashlib.sha256(content).hexdigest()
        except (OSError, ValueError, KeyError, TypeError):  # none of a tune, or no copy
            continue
        if is_theirs and is_whole:
            return KeptConfiguration(folder / CONFIGURATION, content)
    return None


def configuration_file(source: Path, tables: Sequence[AnyTable], prefix: ExportPrefix) -> Mapping[str, bytes]:
    """The same, for tables of one kind, as a file for whoever gets their code; none where there is no copy."""
    kept = configuration_beside(source, tables)
    named = prefix.of_kind(AIM) if isinstance(tables[0], AimTable) else prefix
    return {named.renamed(NAME): kept.content} if kept else {}


OnTables = TypeVar("OnTables", bound="TablesOptions")


def configuration_of(
    asked: Asked[ResolvedConfig | None, OnTables], tables: Sequence[StageTable]
) -> tuple[ResolvedConfig, str]:
    """(the configuration that is asked for, else that of `tables`, what messages call it); `InputError`."""
    return (asked.settings, asked.place) if asked.settings else configuration_for(None, asked.options.source, tables)


def configuration_for(path: Path | None, source: Path, tables: Sequence[StageTable]) -> tuple[ResolvedConfig, str]:
    """(the configuration at `path`, what messages call it); `InputError`.

    Without a path the copy that lies beside the `tables` at `source`. Without one the built-in configuration: that with
    point sensors where all tables are for point sensors at its position.
    """
    from synth.frame.settings.settings_file import BUILT_IN
    from synth.retarder.configuration.config_file import (
        BUILT_IN_SENSORS,
        DUMPER_POSITION,
        built_in_sensors,
        load_config,
    )
    from tuning_tables.passages.passage_table import PassageTable

    if path is not None:
        return load_config(path), str(path)
    kept = configuration_beside(source, tables)
    if kept is not None:
        return kept_config(kept.path), str(kept.path)
    passages = [table for table in tables if isinstance(table, PassageTable)]
    if passages and all(table.retarder.name == DUMPER_POSITION for table in passages):
        return built_in_sensors(), BUILT_IN_SENSORS
    return load_config(None), BUILT_IN


def made_elsewhere(tables: Sequence[StageTable], config: ResolvedConfig, place: str) -> tuple[str, ...]:
    """A warning where `tables` were made from another configuration than `config`, which messages call `place`."""
    made = {table.generator.config_sha256 for table in tables}
    other = f"tables were made from another configuration than {place}; the plant may differ"
    return () if made == {config.sha256} else (other,)


def given_config(text: str, place: str) -> ResolvedConfig | None:
    """The configuration in `text`; None without a file: then the tables tell which one is theirs."""
    from synth.frame.settings.settings_file import BUILT_IN
    from synth.retarder.configuration.config_file import parse_config

    return None if place == BUILT_IN else parse_config(text, place)


def kept_config(path: Path) -> ResolvedConfig:
    """The configuration in the copy at `path`; `InputError`, also with what to do where it names files."""
    from synth.frame.faults import InputError
    from synth.retarder.configuration.config_file import load_config

    try:
        return load_config(path)
    except InputError as fault:
        told = f"{path}: this is the copy beside the tables; if it names files that lie beside yours, give --config"
        raise InputError(*fault.sentences, told) from None
