"""What is shown of what the computer pays: what a manager asks first (what it brings, when it pays back, whether
it is ready, in time), and all figures at the configured values and over all uncertain inputs.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import asdict
from typing import Any

from synth.computer.computer_results import (
    ComputerResults,
    UncertainMoney,
    amounts_of,
    money_limit,
    never_of,
    per_cent_of_time,
    quantiles_of,
    reliability_limit,
    speed_limit,
    when,
)
from synth.computer.economics.economic_case import Item, total
from synth.computer.economics.monte_carlo import OutputFigures
from synth.computer.economics.sensitivity import SobolIndex
from synth.computer.settings import unpriced
from synth.frame.exhibits import Chart, Column, Exhibit, Row, Sentence, Table, Tile, Tiles, shown_value
from synth.frame.interval import Interval
from synth.frame.printed_numbers import amount, as_known, decimals, per_cent, three_figures


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


def or_never(value: float) -> str:
    """Three figures of an amount; a time that never comes has none."""
    if math.isinf(value):
        return "never" if value > 0.0 else "at once"
    return amount(value)


ITEMS = (
    Column("name", "item", words=True),
    Column("quantity", "quantity"),
    Column("unit", "unit", words=True),
    Column("price", "price"),
    Column("amount", "amount", form=amount),
)
FIGURES = (
    Column("figure", "figure", words=True),
    Column("value", "value", form=amount),
    Column("unit", "unit", words=True),
)
WORK = (Column("figure", "of a day", words=True), Column("today", "today"), Column("new", "with the new control"))
DRAWS = (
    Column("output", "figure", words=True),
    Column("q05", "5 %", form=or_never),
    Column("q50", "median", form=or_never),
    Column("q95", "95 %", form=or_never),
    Column("mean", "mean", form=amount),
    Column("never", "never", form=per_cent),
    Column("draws", "draws"),
)
BARS = (
    Column("input", "input", words=True),
    Column("low_input", "its 5 %"),
    Column("high_input", "its 95 %"),
    Column("at_low", "result at 5 %", form=or_never),
    Column("at_high", "result at 95 %", form=or_never),
)
SOBOL = (
    Column("output", "output", words=True),
    Column("input", "input", words=True),
    Column("first", "alone", form=decimals(2)),
    Column("total", "with others", form=decimals(2)),
)


def money(found: ComputerResults) -> Iterator[Exhibit]:
    """What follows for the money, what uncertain inputs leave open, then savings item by item."""
    economics = found.economics
    yield effect(found)
    for warning in unpriced(found.config.settings):
        yield Sentence(f"Warning: {warning}.")
    if found.money is not None:
        yield from over_draws(found.money)
    yield Table("economics", "Figures of the economics", FIGURES, list(figure_rows(found)))
    yield from items("savings", "Savings of a year", economics.savings)
    yield from items("capital", "Capital that is set free", economics.capital)
    yield Table("work", "The hump today and with the new control", WORK, list(work_rows(found)))
    if found.money is not None:
        yield from by_input(found, found.money)


def items(name: str, title: str, held: Sequence[Item]) -> Iterator[Exhibit]:
    """Quantities, prices, amounts, and their sum."""
    rows: list[Row] = [{**asdict(each), "amount": each.amount} for each in held]
    rows.append({"name": "all", "amount": total(tuple(held))})
    yield Table(name, title, ITEMS, rows)


def effect(found: ComputerResults) -> Sentence:
    """What follows for the money at the configured values."""
    economics, settings = found.economics, found.config.settings
    currency, loss = settings.prices.currency, settings.reliability.loss_per_year()
    return Sentence(
        f"At the configured values, which are uncertain where a range is given: effect of a year "
        f"{amount(economics.effect_per_year)} {currency}, losses by failures of {amount(loss)} "
        f"{currency} taken off. {economics.pay_back.statement} Net present value over {settings.terms.years} years: "
        f"{amount(economics.net_present_value)} {currency}. {economics.internal_rate.statement}",
        {"failure_loss_per_year": loss},
        brief=True,
    )


def figure_rows(found: ComputerResults) -> Iterator[Row]:
    """The figures of the economics."""
    economics, currency = found.economics, found.config.settings.prices.currency
    units = {"pay_back_rate_per_year": "1/a", "pay_back_years": "a", "discounted_pay_back_years": "a"}
    for name, value in economics.figures().items():
        yield {"figure": name.replace("_", " "), "value": value, "unit": units.get(name, currency)}
    yield {"figure": "internal rate", "value": economics.internal_rate.per_year, "unit": "1/a"}


def work_rows(found: ComputerResults) -> Iterator[Row]:
    """The work of a day, before and after."""
    today, new = asdict(found.economics.today), asdict(found.economics.new)
    for name, value in today.items():
        yield {"figure": name.replace("_", " "), "today": value, "new": new[name]}


def over_draws(over: UncertainMoney) -> Iterator[Exhibit]:
    """Quantiles, and draws that are impossible."""
    impossible = over.draws.impossible
    yield Table("draws", "Over all uncertain inputs", DRAWS, [draw_row(each) for each in over.figures], brief=True)
    yield Sentence(
        f"{over.draws.n} draws. Of these are impossible: {shown_value(impossible, per_cent)}, mostly "
        "by overload of the hump; they are left out. Brackets: 95 % intervals of the draws.",
        {"draws": over.draws.n, "impossible": impossible,
         "why_impossible": [{"sentence": text, "draws": n} for text, n in over.draws.found.faults]},
    )  # fmt: skip


def by_input(found: ComputerResults, over: UncertainMoney) -> Iterator[Exhibit]:
    """Traffic, each input alone, and shares of variance."""
    yield Chart(
        "computer-traffic",
        "Pay-back over traffic",
        "Net present value and reciprocal of the pay-back time over the cars humped a day. The band is what the "
        "uncertain inputs leave open; numbers of cars that more than 5 % of the draws cannot hump are left out.",
        lambda: _pictures().pay_back_over_traffic(found.config),
    )
    yield Chart(
        "computer-tornado",
        "Which input matters",
        "Each uncertain input alone goes from its 5 % to its 95 % quantile. The widest bar is the number to find out "
        "first.",
        lambda: _pictures().tornado_bars(over.tornado, found.config.case.prices.currency),
    )
    middle = {"tornado_at_medians": over.tornado.at_medians}
    yield Table("tornado", f"{over.tornado.output.replace('_', ' ')}, each input alone", BARS, bars_of(over))
    yield Sentence(f"With every input at its median: {amount(over.tornado.at_medians)}.", middle)
    if over.sobol:
        ranked = sorted(over.sobol, key=lambda index: (index.output, -index.total))
        title = "Share of the variance by input (Sobol indices, 95 % intervals)"
        yield Table("sobol", title, SOBOL, [sobol_row(each, found) for each in ranked])
    else:
        yield Sentence(f"No shares of variance: {over.no_sobol}.")


def draw_row(each: OutputFigures) -> Row:
    """One output over the draws that are possible."""
    low, middle, high = each.quantiles
    return {"output": each.name.replace("_", " "), "q05": low, "q50": middle, "q95": high, "mean": each.mean,
            "never": each.never, "draws": each.n}  # fmt: skip


def bars_of(over: UncertainMoney) -> list[Row]:
    """The bars of the tornado."""
    return [asdict(bar) for bar in over.tornado.bars]


def sobol_row(index: SobolIndex, found: ComputerResults) -> Row:
    """One index of an input alone, and with what it does together with others."""
    points = found.config.settings.uncertainty.sobol_points
    return {
        "output": index.output.replace("_", " "),
        "input": index.input,
        "first": holding(index.first, index.first_ci95, points),
        "total": holding(index.total, index.total_ci95, points),
    }


def holding(value: float, ends: tuple[float, float], n: int) -> Interval:
    """The index with its interval: a bootstrap's own ends may by chance leave it out."""
    return Interval(value, min(ends[0], value), max(ends[1], value), n)


def _pictures() -> Any:
    from synth.computer import pictures  # matplotlib

    return pictures
