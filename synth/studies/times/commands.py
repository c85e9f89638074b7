"""The program as a user starts it: processes of their own, with an empty or a filled cache of kernels."""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Sequence
from itertools import count
from pathlib import Path

from synth.frame.input_error import InputError
from synth.studies.timing.turns import Call

COMMAND = Path(sys.executable).with_name("retarder-synth")
NO_PICTURES = "[output]\nplots = false\nreport = false\n"


def run_process(words: Sequence[str], cache: Path | None = None) -> None:
    """Run to the end; exit codes 0 and 1 (limits not met) are both a complete run. Raises `InputError`."""
    # Without NUMBA_CACHE_DIR, which this process has set for itself and which a child would keep to.
    environment = {name: value for name, value in os.environ.items() if name != "NUMBA_CACHE_DIR"}
    if cache is not None:
        environment["RETARDER_SYNTH_CACHE"] = str(cache)
    done = subprocess.run(words, env=environment, capture_output=True, text=True, check=False)
    if done.returncode not in (0, 1):
        last = (done.stderr.strip().splitlines() or ["no word"])[-1]
        raise InputError(f"study times: '{' '.join(words)}' ended with {done.returncode}: {last}")


def start_calls() -> dict[str, Call]:
    """A bare start of Python, and of the program."""
    return {
        "a bare start of Python": lambda: run_process([sys.executable, "-c", "pass"]),
        "`retarder-synth --help`": lambda: run_process([str(COMMAND), "--help"]),
    }


def tune_calls(folder: Path, config: Path | None, cold: bool) -> dict[str, Call]:
    """A tune with everything compiled, `cold` with nothing compiled, and of the default book without pictures."""
    number, bare = count(), folder / "bare.toml"
    words = [] if config is None else [str(config)]

    def tune(words: Sequence[str], cache: Path | None = None) -> None:
        run_process([str(COMMAND), "tune", *words, "-o", str(folder / f"out-{next(number)}")], cache)

    calls: dict[str, Call] = {"tune, warm": lambda: tune(words)}
    if cold:
        calls["tune, nothing compiled"] = lambda: tune(words, folder / f"cold-{next(number)}")
    if config is None:
        bare.write_text(NO_PICTURES, encoding="utf-8")
        calls["tune, warm, without pictures and report"] = lambda: tune([str(bare)])
    return calls
