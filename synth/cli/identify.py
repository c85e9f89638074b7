"""`retarder-synth identify`: the numbers of a position from its measured passes, as a configuration."""

from __future__ import annotations

import sys
import time
from collections.abc import Sequence
from pathlib import Path

from synth.frame.processors import available
from synth.frame.terminal.telling import LIMITS_MISSED, OK, say


def identify_command(
    logs: Sequence[Path], mapping: Path | None, config_path: Path | None, output: Path, as_json: bool
) -> int:
    """Identify the numbers behind `logs`; 1 where a test says that the model does not hold."""
    from synth.frame.creation_time import creation_time, require_date
    from synth.frame.results_directory import results_directory
    from synth.frame.terminal.interrupt import interruptible
    from synth.kernels.cache import guarded
    from synth.yard.measured_passes.config_source import config_source
    from synth.yard.measured_passes.loaded_passes import loaded_passes

    source = config_source(config_path)
    config = source.resolved()
    require_date()
    passes = loaded_passes(logs, mapping, config, source.place, lambda sentence: say(f"warning: {sentence}"))
    from synth.present.identify_outputs import write_identified
    from synth.yard.measured_passes.identify import identify
    from synth.yard.measured_passes.identify_summary import identify_sentences, other_tests

    started = time.monotonic()
    reads = [*logs, *filter(None, (mapping, config_path)), *(Path(each.place) for each in source.library.own)]
    with results_directory(output, "identify", reads) as directory, interruptible(directory):
        found = guarded(identify, passes, config, available())
        say(f"{len(passes)} passes told after {time.monotonic() - started:.1f} s")
        write_identified(found, source, creation_time(), directory)
    if as_json:
        sys.stdout.write((output / "summary.json").read_text(encoding="utf-8"))
    else:
        from synth.frame.terminal.printed_page import print_page

        left = f"{output}: config.toml, plots/, report.html, summary.json"
        print_page(*identify_sentences(found), *other_tests(found), left)
    return LIMITS_MISSED if found.wrong else OK
