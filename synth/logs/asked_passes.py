"""What every command on measured passes asks: sound passes of the position of a configuration."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from synth.frame.command import Head
from synth.logs.fitting_passes import FittingPasses
from synth.logs.loaded_passes import loaded_passes
from synth.logs.log_options import LogOptions
from synth.retarder.configuration.resolved_config import ResolvedConfig
from synth.retarder.configured import head_of


@dataclass(frozen=True, eq=False)
class AskedPasses:
    """`passes` by the cut classes of `config`, which messages call `place`; `warnings` tell what is left out."""

    config: ResolvedConfig
    place: str
    passes: FittingPasses
    warnings: tuple[str, ...]

    def head(self, more_warnings: tuple[str, ...] = (), reads: tuple[Path, ...] = ()) -> Head:
        """What is said of configuration and logs, with the other files that are read."""
        return head_of(self.config, (*self.warnings, *more_warnings), reads)


def asked_passes(options: LogOptions, config: ResolvedConfig, place: str) -> AskedPasses:
    """The passes of the logs that were typed; `InputError` where none is sound, or no class fits one."""
    warnings: list[str] = []
    passes = loaded_passes(options.logs, options.mapping, config, place, warnings.append)
    return AskedPasses(config, place, passes, tuple(warnings))
