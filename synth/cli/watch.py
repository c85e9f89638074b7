"""`retarder-synth watch`: charts of a position's measured passes, and what has drifted."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from synth.frame.terminal.telling import LIMITS_MISSED, OK, say

if TYPE_CHECKING:
    from synth.yard.measured_passes.fitting_passes import FittingPasses


@dataclass(frozen=True)
class AskedWatch:
    """What the command line asks for: logs, what they are held against, and where the results go."""

    logs: Sequence[Path]
    reference: Sequence[Path]
    config: Path | None
    mapping: Path | None
    output: Path

    @property
    def reads(self) -> tuple[Path, ...]:
        """The files that are read."""
        return (*self.logs, *self.reference, *filter(None, (self.config, self.mapping)))


def watch_command(asked: AskedWatch, as_json: bool) -> int:
    """Watch the passes in the logs; 1 if something has drifted."""
    from synth.configuration.config_file import BUILT_IN, load_config
    from synth.frame.creation_time import creation_time, require_date
    from synth.frame.processors import available
    from synth.frame.results_directory import results_directory
    from synth.frame.terminal.interrupt import interruptible
    from synth.kernels.cache import guarded

    config = load_config(asked.config)
    require_date()
    name = str(asked.config or BUILT_IN)
    from synth.yard.measured_passes.loaded_passes import loaded_passes

    def loaded(paths: Sequence[Path]) -> FittingPasses:
        return loaded_passes(paths, asked.mapping, config, name, lambda sentence: say(f"warning: {sentence}"))

    passes = loaded(asked.logs)
    reference = loaded(asked.reference) if asked.reference else None
    from synth.present.watch_outputs import write_watch
    from synth.yard.measured_passes.drift.baseline import configured, of_reference
    from synth.yard.measured_passes.drift.watch import watch

    with (
        results_directory(asked.output, "watch", asked.reads, "watch.json") as directory,
        interruptible(directory, "watch.json"),
    ):
        values, slope_key = guarded(configured, passes, config.parameters)
        if reference is not None:
            values = guarded(of_reference, reference, config.parameters, values, available())
        found = guarded(watch, passes, values, slope_key, available())
        written = write_watch(found, config, creation_time(), directory)
    if as_json:
        print(written.json, end="")
    else:
        from synth.frame.terminal.printed_page import print_page

        print_page(*written.verdict, f"watch.json, charts.csv, watch.png and report.html in {asked.output}")
    return OK if found.drift is None else LIMITS_MISSED
