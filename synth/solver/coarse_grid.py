"""A grid that is too coarse for what stands on it: how that shows, and what to do."""

from __future__ import annotations

from typing import Final

from plant_models import PlantError


class CoarseGridError(PlantError):
    """Nothing can be polished on this grid. The message tells what shows it, and what to change; `keys`: of a
    configuration, whose values the message is about."""

    def __init__(self, sentence: str, keys: tuple[str, ...] = ()) -> None:
        super().__init__(sentence)
        self.keys = keys


FINER_SPEED: Final = (
    "make grid.speed_step_m_s smaller, to a half or a quarter; a smaller grid.path_step_m alone can make it worse"
)
STEPS: Final = ("grid.speed_step_m_s", "grid.path_step_m")

OWN_GRID: Final = (
    "the grid for commands at any time follows from the sensor and the target and not from [grid]: leave this target "
    'out, or set regulator.commands to "at_rest"'
)


def require_positive(cost_m2_s2: float, start: str, remedy: str = FINER_SPEED, keys: tuple[str, ...] = STEPS) -> float:
    """The expected cost of what a polish starts from; `CoarseGridError` if it is not positive. `start`: a plural noun.

    The cost is a mean of squares, but values between the nodes of the speed grid are taken by cubic interpolation,
    whose weights are negative in part. Where the speeds of the cuts are spread over few cells, the sum can come out
    negative. Finer cells of speed end that. Finer quanta of path alone need not: each is one interpolation more.
    """
    if not cost_m2_s2 > 0.0:
        sentence = f"the grid is too coarse for these {start} (an expected square came out negative): {remedy}"
        raise CoarseGridError(sentence, keys)
    return cost_m2_s2
