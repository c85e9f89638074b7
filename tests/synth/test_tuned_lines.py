"""The rounds of a polish."""

from __future__ import annotations

import numpy as np

from synth.solver.evaluation import Gradient
from synth.solver.switching_lines import SwitchingLines
from synth.solver.tuned_lines import remembering


def test_the_same_lines_are_evaluated_once() -> None:
    """Equal lines have the answer of before, others their own: lower and upper lines are not taken for one another."""
    asked: list[SwitchingLines] = []

    def evaluate(lines: SwitchingLines) -> Gradient:
        asked.append(lines)
        return float(len(asked)), lines.lower_m_s

    def lines(lower: float, upper: float) -> SwitchingLines:
        return SwitchingLines(np.zeros(1), np.full((2, 1), lower), np.full((2, 1), upper))

    answer = remembering(evaluate)
    costs = [answer(lines(*each))[0] for each in ((1.0, 2.0), (2.0, 1.0), (1.0, 2.0), (1.0, 2.0 + 1e-12), (2.0, 1.0))]
    assert costs == [1.0, 2.0, 1.0, 3.0, 2.0]
    assert len(asked) == 3
