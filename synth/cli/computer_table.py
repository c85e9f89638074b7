"""The end of a control computer in words and figures, on stdout."""

from __future__ import annotations

from pathlib import Path

from synth.present.report.computer_tables import money, number, quantile
from synth.yard.control_computer.computer_acceptance import ComputerVerdict
from synth.yard.control_computer.computer_results import ComputerResults


def print_computer(results: ComputerResults, verdict: ComputerVerdict, directory: Path) -> None:
    """Speed, reliability and pay-back, the verdict, and where the files are."""
    sized, found, config = results.sized, results.reliable, results.config
    currency = config.case.prices.currency
    for each in sized.waits:
        long_s = each.simulated.long_s
        print(
            f"{each.formula.task}: waits {number(each.formula.start_s)} s in the mean; "
            f"more than {long_s:g} s: {number(each.long_share.value)} of requests"
        )
    print(
        f"needed on demand {sized.needed_op_s[config.service.discipline]:,.0f} op/s, in cycles {sized.cyclic_op_s:,.0f}"
    )
    for row in sized.controllers:
        print(f"{row.controller.name}: {row.most} positions at most; the hump has {row.all_positions.positions}")
    print(
        f"losses of a year by failures: one computer {money(sum(found.single_loss), currency)}, "
        f"two {money(found.duplex_loss, currency)}"
    )
    print(
        f"effect of a year {money(results.economics.effect_per_year, currency)}; net present value "
        f"{money(results.economics.net_present_value, currency)}. {results.economics.pay_back.statement}"
    )
    if results.money is not None:
        figures = {each.name: each for each in results.money.figures}
        value = figures["net_present_value"]
        print(
            f"over {value.n} draws: net present value {quantile(*value.quantiles[0][1:])} (5 %) to "
            f"{quantile(*value.quantiles[-1][1:])} (95 %); never pays back in "
            f"{100.0 * figures['pay_back_years'].never.value:.3g} % of them"
        )
    print(f"{'accepted' if verdict.accepted else 'not accepted'}: {verdict.sentence}")
    output = config.settings.output
    print(f"{directory}: {'plots/, ' * output.plots}{'report.html, ' * output.report}summary.json")
