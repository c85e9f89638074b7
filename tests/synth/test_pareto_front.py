"""What less time costs, from figures that are made up: which price is nearly free, and where it is told."""

from __future__ import annotations

from dataclasses import replace

from synth.book.pareto.pareto_front import PRICES_M2_S3, ParetoFront, ParetoPoint, nearly_free, told
from synth.present.plots.pareto_fronts import pareto_fronts
from synth.present.report.pareto_section import pareto_section
from synth.simulation.exit_statistics import exit_statistics
from tests.synth.all_pictures import all_pictures
from tests.synth.case_factory import make_case, make_sample


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
        "A price of 3e-05 m2/s3 on a second makes no rms more than 1% larger beyond its 95 % interval, and passes "
        "0.02 to 0.40 s shorter, than none (criterion.time_price_m2_s3)."
    )
    assert nearly_free([SECOND]) == 1e-4


def test_a_price_without_a_table_ends_it() -> None:
    points = tuple(each for each in FIRST.points if each.time_price_m2_s3 != 1e-5)
    assert nearly_free([replace(FIRST, points=points)]) == 0.0
    assert told([replace(FIRST, points=points)]).startswith("Already a price of 1e-05 m2/s3 on a second makes some rms")


def test_report_and_pictures_tell_it_where_it_was_asked_for() -> None:
    section = pareto_section([FIRST, SECOND])
    assert told([FIRST, SECOND]) in section
    assert "gondola-85t to 3 m/s" in section
    case = make_case("gondola-22t", 3.0)
    names = [[each.name for each in all_pictures([one], 0.1)] for one in (case, replace(case, front=FIRST))]
    assert set(names[1]) - set(names[0]) == {"pareto-fronts"}
    assert len(pareto_fronts([FIRST] * 4).axes) == 6
