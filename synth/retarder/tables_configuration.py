"""The configuration by which a command understands tables: the user's, else the one that they were made of."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, TypeVar

if TYPE_CHECKING:
    from synth.frame.command import Asked
    from synth.retarder.configuration.resolved_config import ResolvedConfig
    from synth.retarder.tables_options import TablesOptions
    from tuning_tables.table_kinds import StageTable


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
    from synth.retarder.configuration.config_file import load_config
    from synth.retarder.configuration.config_template import BUILT_IN_SENSORS, DUMPER_POSITION, built_in_sensors
    from synth.retarder.forms.configuration_beside import configuration_beside
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
    from synth.frame.input_error import InputError
    from synth.retarder.configuration.config_file import load_config

    try:
        return load_config(path)
    except InputError as fault:
        told = f"{path}: this is the copy beside the tables; if it names files that lie beside yours, give --config"
        raise InputError(*fault.sentences, told) from None
