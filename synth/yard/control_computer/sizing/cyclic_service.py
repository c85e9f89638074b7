"""Cyclic service: in every cycle the computer goes through all objects, whether something is new or not."""

from __future__ import annotations

import math
from dataclasses import dataclass

from plant_models.errors import require, require_between
from synth.yard.control_computer.sizing.task import TaskMix, require_speed


@dataclass(frozen=True)
class Cycle:
    """A cycle of `cycle_s`, α `check_share` and δ `recovery_share`.

    α is the part of the cycle that checks take which cannot be done beside the work; δ the part that is kept for the
    machine to recover from an error and go through its work again. Raises `PlantError`.
    """

    cycle_s: float
    check_share: float = 0.0
    recovery_share: float = 0.0

    def __post_init__(self) -> None:
        require(
            math.isfinite(self.cycle_s) and self.cycle_s > 0.0,
            f"cycle_s is {self.cycle_s!r}; it must be a finite number above 0",
        )
        require_between("check_share", self.check_share, 0.0, 100.0)
        require(
            0.0 <= self.recovery_share < 1.0,
            f"recovery_share is {self.recovery_share!r}; it must be from 0 to less than 1",
        )

    @property
    def useful_share(self) -> float:
        """(1 − δ) / (1 + α): the share of the cycle that is left for the work.

        The print of [hump-computer-1970s] has (1 − δ)/(1 + α) in the formula and (1 − α) in the text. With α = 1,
        checks as long as the work, the second has no finite speed, and the work takes half of the time: (1 + α).
        """
        return (1.0 - self.recovery_share) / (1.0 + self.check_share)


def cyclic_speed(operations_a_cycle: float, cycle: Cycle) -> float:
    """V = N_c / [((1 − δ)/(1 + α)) · T_c], op/s: the least speed at which all N_c operations end within the cycle.

    [hump-computer-1970s], chapter 3. `PlantError` unless N_c is above 0.
    """
    require(
        math.isfinite(operations_a_cycle) and operations_a_cycle > 0.0,
        f"operations_a_cycle is {operations_a_cycle!r}; it must be a finite number above 0",
    )
    return operations_a_cycle / (cycle.useful_share * cycle.cycle_s)


def used_share(mix: TaskMix, speed_op_s: float, cycle: Cycle, checks_count: bool) -> float:
    """The share of the speed that brings something new: Σ λ_i L_i / V, with the checks of that work if they count.

    The rest of a cycle confirms what is known. [hump-computer-1970s] tells 7 to 8 %, not whether checks count.
    """
    require_speed(speed_op_s)
    work = mix.operations_per_s / speed_op_s
    return work / cycle.useful_share if checks_count else work


def operations_for_use(share: float, speed_op_s: float, rate_per_s: float, cycle: Cycle, checks_count: bool) -> float:
    """The mean number of operations a request that gives `share`: `used_share` solved for L.

    It shows that three figures of [hump-computer-1970s] are of different mixes of tasks. At 20 000 op/s (open loop) a
    use of 7 to 8 % and 0.825 requests a second give L from 850 to 1 940; a wait below 0.01 s at 1 500 op/s allows 219
    at most. At 10⁶ op/s (feedback) they give 42 000 to 97 000; the same work has 8 000 in the text.
    """
    require_between("share", share, 0.0, 1.0)
    require_speed(speed_op_s)
    require(
        math.isfinite(rate_per_s) and rate_per_s > 0.0,
        f"rate_per_s is {rate_per_s!r}; it must be a finite number above 0",
    )
    operations = share * speed_op_s / rate_per_s
    return operations * cycle.useful_share if checks_count else operations
