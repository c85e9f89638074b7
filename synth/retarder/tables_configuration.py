"""The configuration by which a command understands tables: the user's, else the one that is built in for their kind."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from synth.retarder.configuration.resolved_config import ResolvedConfig
    from tuning_tables.passages.passage_table import PassageTable


def configuration_for(path: Path | None, passages: Sequence[PassageTable]) -> tuple[ResolvedConfig, str]:
    """(the configuration at `path`, what messages call it).

    Without a path that of `sensors tune` where all of `passages` are for its position, else that of `tune`.
    """
    from synth.frame.settings.settings_file import BUILT_IN
    from synth.retarder.configuration.config_file import load_config
    from synth.retarder.configuration.point_sensors.template import BUILT_IN_SENSORS, DUMPER_POSITION, built_in_sensors

    if path is None and passages and all(table.retarder.name == DUMPER_POSITION for table in passages):
        return built_in_sensors(), BUILT_IN_SENSORS
    return load_config(path), str(path or BUILT_IN)
