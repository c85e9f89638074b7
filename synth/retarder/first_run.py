"""A first run: the kernels that it needs last are compiled beside it, in a second process.

numba compiles one kernel after the other within a process. A tune compiles its solver and its closed loop as it comes
to them; what values a policy, forward and backward, takes two fifths of all, and is needed last. The second process
leaves it in the cache, where the first one finds it.
"""

from __future__ import annotations

import subprocess
import sys
import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from threading import Thread

from synth.kernels.cache import first_time

COARSE_STEP_M, COARSE_STEP_M_S = 2.0, 0.2
"""A grid on which all that is valued takes no time beside the compiling."""

COMMAND = (sys.executable, "-P", "-m", "synth.retarder.first_run")


@contextmanager
def compiled_beside(tell: Callable[[str], None], command: Sequence[str] = COMMAND) -> Iterator[None]:
    """While the block runs, and if no kernel is kept for this machine: a second process compiles what is needed last.

    It is ended with the block. What it leaves is whole: numba puts a kernel into the cache at one stroke.
    """
    if not first_time():
        yield
        return
    tell("compiling the kernels for this machine, once, in two processes; the first case comes in about a minute")
    nowhere = subprocess.DEVNULL
    beside = subprocess.Popen(command, stdin=nowhere, stdout=nowhere, stderr=nowhere)
    Thread(target=told_when_done, args=(beside, time.monotonic(), tell), daemon=True).start()
    try:
        yield
    finally:
        beside.kill()
        beside.wait()


def told_when_done(beside: subprocess.Popen[bytes], started_s: float, tell: Callable[[str], None]) -> None:
    """Tell how long the second process took, if it did its work."""
    if beside.wait() == 0:
        tell(f"kernels that value a policy: compiled in {time.monotonic() - started_s:.0f} s beside the others")


def value_a_policy() -> None:
    """Value a policy of the default position once, on a coarse grid, with the gradient."""
    import numpy as np

    from synth.problem.problem import Aim
    from synth.problem.resolution import Resolution
    from synth.retarder.configuration.config_file import parse_config
    from synth.solver.chain.chain import persistent_chain
    from synth.solver.evaluation import Evaluation, density_and_occupancy
    from synth.solver.switching_lines import SwitchingLines

    config = parse_config("", "the default configuration")
    label, plant = config.plants()[0]
    coarse = Resolution(COARSE_STEP_M, COARSE_STEP_M_S, friction_nodes=1, path_levels=1, resistance_nodes=1)
    chain, target = persistent_chain(plant, coarse), config.targets_of(label)[0]
    shape = (plant.top_stage + 1, len(chain.grid.path_m))
    lines = SwitchingLines(chain.grid.path_m, np.full(shape, target - 0.1), np.full(shape, target + 0.1))
    density_and_occupancy(chain, lines)
    Evaluation(chain, Aim(target, config.criterion)).gradient(lines)


if __name__ == "__main__":
    value_a_policy()
