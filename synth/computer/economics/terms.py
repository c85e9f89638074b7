"""What the new control costs, and by which terms it is judged."""

from __future__ import annotations

from plant_models.library.sourced_value import JUDGEMENT
from synth.computer.economics.pay_back import TRAPEZNIKOV_INTEREST_PER_YEAR
from synth.computer.origins import MONEY, USUAL
from synth.frame.settings.section import Section, setting


class Terms(Section):
    """What the new control costs, and by which terms it is judged.

    Pay-back counts all released capital by the normative efficiency, as its formula does.
    """

    investment: float = setting(1_000_000.0, "currency", -1e15, 1e15, "what it costs more than what it replaces", USUAL)
    running_cost_per_year: float = setting(
        100_000.0, "currency/a", -1e15, 1e15, "upkeep more than today, losses by failures left out", USUAL
    )
    fixed_saving_per_year: float = setting(
        150_000.0, "currency/a", -1e15, 1e15, "what is saved whatever the traffic", f"{JUDGEMENT}: staff"
    )
    normative_efficiency_per_year: float = setting(
        0.12, "1/a", 0.0, 1.0, "yearly worth of released capital", f"{MONEY}: 0.12 to 0.15"
    )
    discount_per_year: float = setting(0.05, "1/a", 0.0, 1.0, "discount of later money", USUAL)
    years: int = setting(15, "a", 1, 200, "life of the computer", USUAL)
    cashed_share: float = setting(
        0.0, "1", 0.0, 1.0, "part of the released capital that is sold at the start", f"{JUDGEMENT}: none"
    )
    interest_per_year: float = setting(
        TRAPEZNIKOV_INTEREST_PER_YEAR, "1/a", 0.0, 1.0, "simple interest of the pay-back formula", MONEY
    )
