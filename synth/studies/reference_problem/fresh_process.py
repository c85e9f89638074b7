"""One solve in a process of its own, imports included: `python -m` of this module NAME THREADS STAGES."""

from __future__ import annotations

import time

STARTED = time.perf_counter()

import json  # noqa: E402  # the time counts from here
import os  # noqa: E402
import resource  # noqa: E402
import subprocess  # noqa: E402
import sys  # noqa: E402
import tempfile  # noqa: E402
from dataclasses import dataclass  # noqa: E402
from pathlib import Path  # noqa: E402


@dataclass(frozen=True)
class Fresh:
    """Seconds of a first solve without and with compiled kernels, and the most memory of the second process."""

    name: str
    cold_s: float
    warm_s: float
    peak_mb: float


def fresh_process(name: str, threads: int, stages: int) -> Fresh:
    """Run the solver called `name` in two processes, the first with an empty cache of kernels."""
    with tempfile.TemporaryDirectory() as cache:
        # Without NUMBA_CACHE_DIR, which this process has set for itself and which a child would keep to.
        environment = {key: value for key, value in os.environ.items() if key != "NUMBA_CACHE_DIR"}
        environment["RETARDER_SYNTH_CACHE"] = cache
        command = [sys.executable, "-m", __spec__.name, name, str(threads), str(stages)]
        runs = [
            subprocess.run(command, env=environment, capture_output=True, text=True, check=True).stdout
            for _ in range(2)
        ]
    cold, warm = (json.loads(run.splitlines()[-1]) for run in runs)
    return Fresh(name, cold["seconds"], warm["seconds"], warm["peak_mb"])


def peak_memory_mb() -> float:
    """Largest resident memory of this process; Linux's ru_maxrss would count the parent's before the start as well."""
    try:
        status = Path("/proc/self/status").read_text(encoding="ascii")
        return float(status.partition("VmHWM:")[2].split()[0]) / 1024.0
    except (OSError, IndexError):
        return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024.0


def main(name: str, threads: int, stages: int) -> None:
    """Solve once, print seconds and memory."""
    from synth.studies.reference_problem.problem import ReferenceProblem
    from synth.studies.reference_problem.solvers import solver_named

    solver_named(name, threads)(ReferenceProblem(stages=stages))
    print(json.dumps({"seconds": time.perf_counter() - STARTED, "peak_mb": peak_memory_mb()}))


if __name__ == "__main__":
    main(sys.argv[1], int(sys.argv[2]), int(sys.argv[3]))
