"""Tables of the report of a control computer."""

from __future__ import annotations

import math
from collections.abc import Sequence

from synth.book.printed_numbers import ABSENT
from synth.present.report.markup import Cell, Markup, element, head_row, joined, table
from synth.yard.control_computer.computer_results import ComputerResults, UncertainMoney
from synth.yard.control_computer.economics.savings import Item, total
from synth.yard.control_computer.reliability.upkeep import Upkeep
from synth.yard.control_computer.sized_computer import SizedComputer, TaskWait
from synth.yard.control_computer.sizing.batch_means import SampledMean
from synth.yard.control_computer.sizing.inputs_outputs import source_channels, total_channels
from synth.yard.control_computer.sizing.memory_need import Memory


def sizing_tables(results: ComputerResults) -> Markup:
    """Waits, speeds, controllers, channels."""
    sized, service = results.sized, results.config.settings.service
    long_s = service.long_wait_s
    waits = table(
        "Waits at the configured speed",
        (head_row("task", "mean wait, s", "simulated", f"share above {long_s:g} s", "simulated", "late", "n"),),
        [(wait_cells(each), "") for each in sized.waits],
        kind="cases",
    )
    speeds = table(
        "Speed that is needed",
        (head_row("service", "op/s"),),
        [
            *(([each.value, f"{speed:,.0f}"], "") for each, speed in sized.needed_op_s.items()),
            ([f"in cycles of {results.config.cycle.cycle_s:g} s, used {100.0 * sized.cyclic_used:.2g} %",
              f"{sized.cyclic_op_s:,.0f}"], ""),
        ],
        kind="cases",
    )  # fmt: skip
    return joined((waits, speeds, controller_table(sized), channel_table(sized), memory_line(sized)))


def wait_cells(each: TaskWait) -> list[str | Cell]:
    """The row of a task."""
    late = ABSENT if each.late_share is None else number(each.late_share.value)
    return [
        each.formula.task, number(each.formula.start_s), told(each.simulated.start_s), number(each.long_share.value),
        told(each.simulated.long_share), late, str(each.simulated.start_s.count),
    ]  # fmt: skip


def controller_table(sized: SizedComputer) -> Markup:
    """Which controller carries how many positions."""
    rows: list[tuple[list[str | Cell], str]] = []
    for row in sized.controllers:
        at = row.all_positions
        answer = "too slow" if math.isinf(at.answer_s) else f"{1e3 * at.answer_s:.3g} ms"
        margin = ABSENT if math.isinf(at.answer_s) else f"{1e3 * at.answer_margin_s:.3g} ms"
        rows.append(([Cell(row.controller.name, note=row.controller.source), f"{row.most}", answer, margin,
                      f"{100.0 * at.used_share:.3g} %"], "" if at.in_time else "bad"))  # fmt: skip
    positions = sized.controllers[0].all_positions.positions
    head = ("controller", "positions at most", f"answer with {positions} positions", "margin", "time used")
    return table("Controllers at the track", (head_row(*head),), rows, kind="cases")


def channel_table(sized: SizedComputer) -> Markup:
    """Inputs and outputs by kind of element."""
    head = ("element", "number", "digital in", "analog in", "digital out", "analog out")
    rows = [(channel_cells(each.kind.replace("_", " "), str(each.count), each.all), "") for each in sized.channels]
    rows.append((channel_cells("all", "", total_channels(sized.channels)), ""))
    rows.append((channel_cells("the source asked for", "", source_channels()), ""))
    return table("Inputs and outputs", (head_row(*head),), rows, kind="cases")


def channel_cells(name: str, count: str, channels: object) -> list[str | Cell]:
    """A row of channels."""
    return [name, count, *(str(value) for value in vars(channels).values())]


def memory_line(sized: SizedComputer) -> Markup:
    """Word length and memory."""
    kept = ", ".join(f"{sized.memory.kibibytes(each):.3g} KiB {each.name.lower()}" for each in Memory)
    return element("p", f"Words of {sized.word_bits} bits hold every quantity of the hump; memory: {kept}.")


def reliability_table(results: ComputerResults) -> Markup:
    """One computer and two."""
    found, currency = results.reliable, results.config.case.prices.currency
    upkeep: Upkeep = results.config.upkeep
    longest = f"{found.longest_period_h:.3g} h" if found.longest_period_h is not None else found.why_none
    rows = [
        (["one computer: share of time ready", f"{found.single_availability:.6g}"], ""),
        (["one computer: loss of a year", money(sum(found.single_loss), currency)], ""),
        (["of it unnoticed, checks, repair", " + ".join(money(each, "") for each in found.single_loss)], ""),
        (["two computers: share of time with a ready one", f"{found.duplex_availability:.6g}"], ""),
        (["two computers: loss of a year", money(found.duplex_loss, currency)], ""),
        (["best interval of one, by useful hours", hours(found.best_useful_h)], ""),
        (["best interval of one, by the calendar", hours(found.best_calendar_h)], ""),
        ([f"longest period of two for {upkeep.required_availability:g}", longest], ""),
    ]
    return table("Reliability", (head_row("figure", "value"),), rows, kind="cases")


def economics_tables(results: ComputerResults) -> Markup:
    """Savings item by item, and the pay-back."""
    found, currency = results.economics, results.config.case.prices.currency
    parts = [
        item_table("Savings of a year", found.savings, currency),
        item_table("Capital that is set free", found.capital, currency),
        element("p", f"Effect of a year: {money(found.effect_per_year, currency)}, losses by failures of "
                f"{money(results.config.upkeep.loss_per_year(), currency)} taken off. {found.pay_back.statement} "
                f"Net present value over {results.config.case.terms.years} years: "
                f"{money(found.net_present_value, currency)}. {found.internal_rate.statement}"),
        element("p", f"Load of the hump: {found.today.load:.3g} today, {found.new.load:.3g} with the new control; mean "
                f"wait of a train for humping {found.today.wait_h:.3g} h and {found.new.wait_h:.3g} h.",
                class_="meta"),
    ]  # fmt: skip
    if results.money is not None:
        parts += [draw_table(results.money), sobol_table(results.money)]
    return joined(parts)


def item_table(name: str, items: Sequence[Item], currency: str) -> Markup:
    """Quantities, prices, amounts; items that are nothing are left out."""
    shown = [item for item in items if item.amount != 0.0]
    rows = [
        ([item.name, number(item.quantity), item.unit, number(item.price), money(item.amount, "")], "")
        for item in shown
    ]
    rows.append((["all", "", "", "", money(total(tuple(items)), currency)], ""))
    return table(name, (head_row("item", "quantity", "unit", "price", "amount"),), rows, kind="cases")


def draw_table(found: UncertainMoney) -> Markup:
    """Quantiles of the outputs with their intervals."""
    rows = []
    for each in found.figures:
        cells = [each.name.replace("_", " "), *(quantile(*row[1:]) for row in each.quantiles)]
        never = each.never
        cells.append(f"{100.0 * never.value:.3g} % [{100.0 * never.low95:.3g}, {100.0 * never.high95:.3g}]")
        rows.append(([*cells, str(each.n)], ""))
    head = ("figure", "5 %", "median", "95 %", "never", "draws")
    impossible = found.draws.impossible
    lead = element(
        "p",
        f"{found.draws.n} draws; {100.0 * impossible.value:.3g} % of them are impossible "
        f"[{100.0 * impossible.low95:.3g}, {100.0 * impossible.high95:.3g}], mostly by overload of the hump; they are "
        "left out. Brackets: 95 % intervals of the draws.",
        class_="meta",
    )
    return joined((lead, table("Over all uncertain inputs", (head_row(*head),), rows, kind="cases")))


def sobol_table(found: UncertainMoney) -> Markup:
    """Shares of variance."""
    if not found.sobol:
        return element("p", f"No shares of variance: {found.no_sobol}.", class_="meta")
    ranked = sorted(found.sobol, key=lambda index: (index.output, -index.total))
    rows = [([index.output.replace("_", " "), index.input, share(index.first, index.first_ci95),
              share(index.total, index.total_ci95)], "") for index in ranked]  # fmt: skip
    head = ("output", "input", "alone", "with others")
    return table(
        "Share of the variance by input (Sobol indices, 95 % intervals)", (head_row(*head),), rows, kind="cases"
    )


def quantile(value: float, low: float, high: float) -> str:
    """A quantile with its interval."""
    return f"{number(value)} [{number(low)}, {number(high)}]"


def share(value: float, ends: tuple[float, float]) -> str:
    """An index."""
    return f"{value:.2f} [{ends[0]:.2f}, {ends[1]:.2f}]"


def told(found: SampledMean) -> str:
    """A simulated mean."""
    return f"{number(found.mean)} ± {number(found.half_width)}"


def hours(value: float | None) -> str:
    """A time that may not be there."""
    return ABSENT if value is None or math.isinf(value) else f"{value:.3g} h"


def money(value: float, currency: str) -> str:
    """An amount."""
    return f"{value:,.0f} {currency}".strip()


def number(value: float) -> str:
    """Three figures, all of them before the point."""
    if math.isinf(value):
        return "never" if value > 0.0 else "at once"
    return f"{value:,.0f}" if abs(value) >= 1000.0 else f"{value:.3g}"
