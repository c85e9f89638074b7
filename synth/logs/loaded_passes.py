"""The passes of log files that the user names, by the cut classes of a configuration."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path

from synth.frame.input_error import InputError
from synth.logs.fitting_passes import FittingPasses, fitting_passes
from synth.retarder.configuration.resolved_config import ResolvedConfig
from tuning_tables.errors import InvalidLog
from tuning_tables.pass_log.log_files import read_logs
from tuning_tables.pass_log.log_mapping import read_mapping


def loaded_passes(
    logs: Sequence[Path],
    mapping: Path | None,
    config: ResolvedConfig,
    source: str,
    warn: Callable[[str], None],
) -> FittingPasses:
    """The sound passes in `logs`; `warn` is told of files and passes that are left out.

    `source` is what a message calls the configuration. `mapping`: a file that names foreign columns.
    Raises `InputError` where no pass is sound, and for cuts that no class fits.
    """
    try:
        names = None if mapping is None else read_mapping(mapping)
        loaded = read_logs(logs, names, config.retarder.position.top_stage)
    except InvalidLog as fault:
        raise InputError(str(fault)) from None
    for refused in loaded.refused:
        warn(refused.sentence)
    for left_out in loaded.faults:
        warn(left_out.sentence)
    return fitting_passes(loaded.log, config.plants(), source)
