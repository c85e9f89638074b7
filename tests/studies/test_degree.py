"""The study of the degree: what the polish does, and that its prediction is that of the exported table."""

from __future__ import annotations

import pytest

from scripts.studies.degree.study import COMPARED, METHOD, SOLVER_LINES, Degrees, Options


@pytest.fixture(scope="module")
def found() -> Degrees:
    """52 t to 3 m/s, degrees 1 and 3."""
    smallest = METHOD.smallest
    assert isinstance(smallest, Options)
    return METHOD.run(smallest, lambda _: None)


@pytest.mark.long
def test_the_polish_lowers_the_prediction_of_every_degree(found: Degrees) -> None:
    (case,) = found.cases
    *tables, lines = case.rows
    assert [row.degree for row in tables] == [1, COMPARED]
    assert (lines.degree, lines.fitted_predicted_rms_m_s) == (SOLVER_LINES, None)
    for row in tables:
        assert row.fitted_predicted_rms_m_s is not None
        assert row.predicted_rms_m_s < row.fitted_predicted_rms_m_s


def test_every_prediction_is_that_of_the_closed_loop_by_chance(found: Degrees) -> None:
    """The solver's lines too: they are predicted and simulated as they were swept, one stage a command."""
    for row in found.cases[0].rows:
        low, high = row.rms_ci95_m_s
        assert 0.9 * low < row.predicted_rms_m_s < 1.1 * high, row
