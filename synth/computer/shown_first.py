"""What a manager asks first of a control computer: what it brings, when it pays back, whether it is ready, in time."""

from __future__ import annotations

import math
from collections.abc import Iterator

from synth.computer.computer_limits import (
    amounts_of,
    money_limit,
    never_of,
    per_cent_of_time,
    quantiles_of,
    reliability_limit,
    speed_limit,
    when,
)
from synth.computer.computer_results import ComputerResults
from synth.frame.exhibits import Exhibit, Sentence, Tile, Tiles
from synth.frame.printed_numbers import amount, as_known, per_cent, three_figures


def first_screen(found: ComputerResults) -> Iterator[Exhibit]:
    """Tiles, and what to find out first."""
    yield Tiles((effect_tile(found), value_tile(found), pay_back_tile(found), ready_tile(found), speed_tile(found)))
    for sentence in to_do(found):
        yield Sentence(sentence, to_do=True)


def effect_tile(found: ComputerResults) -> Tile:
    """What a year brings, with the verdict on the money."""
    value, span = told_amount(found, "effect_per_year", found.economics.effect_per_year)
    return Tile(value, f"a year, losses by failures taken off{span}", money_limit(found).kept)


def value_tile(found: ComputerResults) -> Tile:
    """What all years are worth today."""
    value, span = told_amount(found, "net_present_value", found.economics.net_present_value)
    return Tile(value, f"net present value over {found.config.settings.terms.years} years{span}")


def told_amount(found: ComputerResults, name: str, configured: float) -> tuple[str, str]:
    """An amount of money with no more figures than its spread leaves, and that spread in words; without uncertain
    inputs as configured."""
    currency = found.config.settings.prices.currency
    if found.money is None:
        return f"{amount(configured)} {currency}", " (at the configured values; no input is uncertain)"
    low, middle, high = amounts_of(found.money, name)
    return f"{middle} {currency}", f": median; {low} to {high} in 90 of 100 draws of the uncertain inputs"


def pay_back_tile(found: ComputerResults) -> Tile:
    """When the investment is paid back."""
    if found.money is None:
        years = found.economics.pay_back.years
        return Tile("never" if years is None else f"{three_figures(years)} years", "until it is paid back")
    _, middle, slow = quantiles_of(found.money, "pay_back_years")
    never = f"never in {per_cent(never_of(found.money).value)} of the draws"
    slowest = never if math.isinf(slow.value) else f"{when(slow)} in 95 of 100 draws"
    return Tile(when(middle), f"it is paid back in the median; {slowest}")


def ready_tile(found: ComputerResults) -> Tile:
    """How much of the time it is ready."""
    upkeep, ready = found.config.settings.reliability, found.reliable.duplex_availability
    if upkeep.structure == "single":
        ready = found.reliable.single_availability
    required = per_cent_of_time(upkeep.required_availability)
    return Tile(per_cent_of_time(ready), f"of the time it is ready; {required} required", reliability_limit(found).kept)


def speed_tile(found: ComputerResults) -> Tile:
    """How much faster it is than its tasks need."""
    service = found.config.settings.service
    share = service.speed_op_s / found.sized.needed_op_s[service.discipline]
    words = f"the speed that the allowed waits need, {found.sized.needed_op_s[service.discipline]:,.0f} op/s"
    return Tile(f"{three_figures(share)} times", words, speed_limit(found).kept)


def to_do(found: ComputerResults) -> Iterator[str]:
    """Which input to find out first."""
    if found.money is None:
        yield "Give ranges of what you do not know for sure ([uncertainty]): without them the money is one number."
        return
    known = [bar for bar in found.money.tornado.bars if math.isfinite(bar.swing) and bar.swing > 0.0]
    if known:
        bar, what = known[0], found.money.tornado.output.replace("_", " ")
        low, high = (amount(as_known(each, bar.at_low, bar.at_high)) for each in (bar.at_low, bar.at_high))
        yield (
            f"Find out {bar.input} first: from {three_figures(bar.low_input)} to {three_figures(bar.high_input)} of it "
            f"the {what} goes from {low} to {high} {found.config.settings.prices.currency}."
        )
