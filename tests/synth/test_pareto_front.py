"""What less time costs, from figures that are made up: which price is nearly free, and where it is told."""

from __future__ import annotations

from dataclasses import replace

from synth.frame.exhibits import Chart, Sentence, Table
from synth.retarder.pareto.pareto_front import PRICES_M2_S3, ParetoFront, ParetoPoint, nearly_free, told
from synth.retarder.pictures.pareto_fronts import pareto_fronts
from synth.retarder.shown.fronts import fronts
from synth.simulation.exit_statistics import exit_statistics
from tests.synth.case_factory import make_sample


def made_front(label: str, ratios: tuple[float, ...], saved_s: tuple[float, ...]) -> ParetoFront:
    """A front of the first prices."""
    found = exit_statistics(make_sample(3.0, 0.03, 0), 3.0)
    points = tuple(
        ParetoPoint(
            price, replace(found, time_s=12.0 - saved, time_ci95_s=(11.9 - saved, 12.1 - saved)), 0.03, ratio,
            (ratio - 0.01, ratio + 0.01),
        )
        for price, ratio, saved in zip(PRICES_M2_S3, ratios, saved_s, strict=False)
    )  # fmt: skip
    return ParetoFront(label, 3.0, points)


FIRST = made_front("gondola-22t", (1.0, 0.99, 1.015, 1.03), (0.0, 0.1, 0.4, 0.9))
SECOND = made_front("gondola-85t", (1.0, 1.0, 1.01, 1.0), (0.0, 0.0, 0.02, 0.2))


def test_the_highest_price_that_is_nearly_free_in_all_cases_is_told() -> None:
    assert nearly_free([FIRST, SECOND]) == 3e-5
    assert told([FIRST, SECOND]) == (
        "A price of 3e-05 m2/s3 on a second makes no rms more than 1% larger beyond its 95 % interval, and changes "
        "the mean time in the position by -0.40 to -0.02 s (criterion.time_price_m2_s3)."
    )
    assert nearly_free([SECOND]) == 1e-4


def test_a_price_without_a_table_ends_it() -> None:
    points = tuple(each for each in FIRST.points if each.time_price_m2_s3 != 1e-5)
    assert nearly_free([replace(FIRST, points=points)]) == 0.0
    assert told([replace(FIRST, points=points)]).startswith("Already a price of 1e-05 m2/s3 on a second makes some rms")


def test_report_and_pictures_tell_it_where_it_was_asked_for() -> None:
    table, chart = (each for each in fronts([FIRST, SECOND]) if not isinstance(each, Sentence))
    assert isinstance(table, Table)
    assert [(row["label"], row["time_price_m2_s3"]) for row in table.rows] == [
        (front.label, price) for front in (FIRST, SECOND) for price in PRICES_M2_S3[:4]
    ]
    assert isinstance(chart, Chart)
    assert len(chart.draw().axes) == len(pareto_fronts([FIRST, SECOND]).axes)
    assert len(pareto_fronts([FIRST] * 4).axes) == 6
