"""All pictures of a control computer: what is drawn, and what is said under it."""

from __future__ import annotations

from collections.abc import Iterator

from synth.present.plots.computer.pay_back_over_traffic import pay_back_over_traffic
from synth.present.plots.computer.tornado_bars import tornado_bars
from synth.present.plots.computer.upkeep_interval import upkeep_interval
from synth.present.plots.computer.waits import waits
from synth.present.plots.picture import Picture
from synth.present.plots.picture_book import picture
from synth.yard.control_computer.computer_results import ComputerResults


def computer_pictures(results: ComputerResults) -> Iterator[Picture]:
    """Every picture in the order of the report."""
    config = results.config
    yield picture(
        waits(config),
        "computer-waits",
        "How fast",
        "Wait over speed",
        "Mean wait of a request for the begin of its service, and the chance of a long one, over the speed of the "
        "processor. Both are formulas; the table above has the simulation beside them at the configured speed.",
    )
    yield picture(
        upkeep_interval(config),
        "computer-checks",
        "How reliable",
        "Checks",
        "Share of time in which no computer is ready, and what that costs in a year, over the interval between checks. "
        "Frequent checks cost time by hand, rare ones leave failures unnoticed.",
    )
    if results.money is not None:
        yield picture(
            pay_back_over_traffic(config),
            "computer-traffic",
            "What it pays",
            "Pay-back over traffic",
            "Net present value and reciprocal of the pay-back time over the cars humped a day. The band is what the "
            "uncertain inputs leave open; numbers of cars that more than 5 % of the draws cannot hump are left out.",
        )
        yield picture(
            tornado_bars(results.money.tornado, config.case.prices.currency),
            "computer-tornado",
            "What it pays",
            "Which input matters",
            "Each uncertain input alone goes from its 5 % to its 95 % quantile. The widest bar is the number to find "
            "out first.",
        )
