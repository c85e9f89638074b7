"""The end of a control computer in words and figures, on stdout."""

from __future__ import annotations

from pathlib import Path

from synth.cli.printed_page import Verdict, print_page
from synth.cli.printed_table import Column, PrintedTable
from synth.present.report.computer_tables import money, number, quantile
from synth.yard.control_computer.computer_acceptance import ComputerVerdict
from synth.yard.control_computer.computer_results import ComputerResults, UncertainMoney
from synth.yard.control_computer.sized_computer import ControllerRow, TaskWait

WAITS = (
    Column[TaskWait]("task", lambda each: each.formula.task, words=True),
    Column[TaskWait]("mean wait, s", lambda each: number(each.formula.start_s)),
    Column[TaskWait]("a wait is long above, s", lambda each: f"{each.simulated.long_s:g}", spare=1),
    Column[TaskWait]("share of long waits", lambda each: number(each.long_share.value)),
)

CONTROLLERS = (
    Column[ControllerRow]("controller", lambda each: each.controller.name, words=True),
    Column[ControllerRow]("positions at most", lambda each: str(each.most)),
    Column[ControllerRow]("positions of the hump", lambda each: str(each.all_positions.positions)),
)


def print_computer(results: ComputerResults, verdict: ComputerVerdict, directory: Path) -> None:
    """Speed, reliability and pay-back, the verdict, and where the files are."""
    sized, found, config = results.sized, results.reliable, results.config
    currency, output = config.case.prices.currency, config.settings.output
    print_page(
        PrintedTable(WAITS, sized.waits, "summary.json"),
        PrintedTable(CONTROLLERS, sized.controllers, "summary.json"),
        f"needed on demand {sized.needed_op_s[config.service.discipline]:,.0f} op/s, in cycles "
        f"{sized.cyclic_op_s:,.0f}",
        f"losses of a year by failures: one computer {money(sum(found.single_loss), currency)}, "
        f"two {money(found.duplex_loss, currency)}",
        f"effect of a year {money(results.economics.effect_per_year, currency)}; net present value "
        f"{money(results.economics.net_present_value, currency)}. {results.economics.pay_back.statement}",
        *([] if results.money is None else [money_sentence(results.money)]),
        Verdict(verdict.accepted, verdict.sentence),
        f"{directory}: {'plots/, ' * output.plots}{'report.html, ' * output.report}summary.json",
    )


def money_sentence(found: UncertainMoney) -> str:
    """What the draws say of the money."""
    figures = {each.name: each for each in found.figures}
    value, never = figures["net_present_value"], figures["pay_back_years"].never.value
    return (
        f"over {value.n} draws: net present value {quantile(*value.quantiles[0][1:])} (5 %) to "
        f"{quantile(*value.quantiles[-1][1:])} (95 %); never pays back in {100.0 * never:.3g} % of them"
    )
