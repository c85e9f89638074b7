"""Cyclic service: in every cycle the computer goes through all objects, whether something is new or not."""

from __future__ import annotations

from synth.computer.origins import SPEED
from synth.computer.sizing.task import TaskMix
from synth.frame.settings.section import Section, setting


class Cycle(Section):
    """The other way of service: all objects in every cycle, whether something is new or not.

    α is the time of the checks that cannot be done beside the work, δ what is kept to go through the work again.
    """

    cycle_s: float = setting(1.0, "s", 1e-6, 1e6, "length of a cycle", SPEED)
    operations: float = setting(
        500_000.0, "1", 1.0, 1e18, "operations of a cycle", f"{SPEED}: what its speed of 1 000 000 op/s tells"
    )
    check_share: float = setting(
        1.0, "1", 0.0, 100.0, "α: time for checks, of that for the work", f"{SPEED}: half of the time is left"
    )
    recovery_share: float = setting(0.0, "1", 0.0, 0.99, "δ: part of the cycle kept to recover from errors", SPEED)

    @property
    def useful_share(self) -> float:
        """(1 − δ) / (1 + α): the share of the cycle that is left for the work.

        The print of [hump-computer-1970s] has (1 − δ)/(1 + α) in the formula and (1 − α) in the text. With α = 1,
        checks as long as the work, the second has no finite speed, and the work takes half of the time: (1 + α).
        """
        return (1.0 - self.recovery_share) / (1.0 + self.check_share)


def cyclic_speed(cycle: Cycle) -> float:
    """V = N_c / [((1 − δ)/(1 + α)) · T_c], op/s: the least speed at which all N_c operations end within the cycle.

    [hump-computer-1970s], chapter 3.
    """
    return cycle.operations / (cycle.useful_share * cycle.cycle_s)


def used_share(mix: TaskMix, speed_op_s: float, cycle: Cycle, checks_count: bool) -> float:
    """The share of the speed that brings something new: Σ λ_i L_i / V, with the checks of that work if they count.

    The rest of a cycle confirms what is known. [hump-computer-1970s] tells 7 to 8 %, not whether checks count.
    """
    work = mix.operations_per_s / speed_op_s
    return work / cycle.useful_share if checks_count else work
