"""A small probability with what is known of its error."""

from __future__ import annotations

import math
from dataclasses import dataclass

from synth.simulation.exit_statistics import clopper_pearson


@dataclass(frozen=True)
class TailProbability:
    """P(exit speed − target > `margin_m_s`) with an interval, and what it cost.

    For sampled methods `low`, `high` are a 95 % interval; for the density they are the probability minus and plus
    the sum of its measured refinement errors. `method` names the way for print; `passes` are passes simulated, or
    hidden scenarios followed forward.
    """

    margin_m_s: float
    probability: float
    low: float
    high: float
    method: str
    passes: int

    def __post_init__(self) -> None:
        if not 0.0 <= self.low <= self.probability <= self.high <= 1.0:
            raise ValueError(f"tail probability: {self.low} … {self.probability} … {self.high} is no interval")

    def gap(self, other: TailProbability) -> float:
        """By what factor both intervals must be stretched about their probabilities to touch; up to 1 they overlap.

        Of two independent 95 % intervals of one quantity the gap exceeds 1 in 0.6 to 5 % of cases (equally wide; one
        without width) and 1.7 in fewer than 0.1 %.
        """
        below, above = (self, other) if self.probability <= other.probability else (other, self)
        room = (below.high - below.probability) + (above.probability - above.low)
        apart = above.probability - below.probability
        return apart / room if room > 0.0 else (0.0 if apart == 0.0 else math.inf)


def sampled_tail(
    margin_m_s: float,
    probability: float,
    standard_error: float,
    quantile: float,
    nominal: int,
    method: str,
    passes: int,
) -> TailProbability:
    """A tail from an unbiased estimate and its standard error, `quantile` (1.96 or Student's) of them either way.

    The limits are those of the logarithm (delta method), below ½ of the probability and above ½ of its complement,
    so that none leaves [0, 1]. Without any variance seen, that is without a hit or without a miss, the limits are
    those of Clopper and Pearson for the `nominal` passes that were drawn from the law itself.
    """
    p = min(max(probability, 0.0), 1.0)
    rare = min(p, 1.0 - p)
    if standard_error == 0.0 or rare == 0.0:
        hits = nominal if p > 0.5 else 0
        exact = clopper_pearson(hits, nominal)
        low, high = min(exact[0], p), max(exact[1], p)
    else:
        spread = math.exp(min(quantile * standard_error / rare, 700.0))
        low, high = rare / spread, min(rare * spread, 1.0)
        if p > 0.5:
            low, high = 1.0 - high, 1.0 - low
    return TailProbability(margin_m_s, p, min(low, p), max(high, p), method, passes)


def crude_tail(margin_m_s: float, hits: int, passes: int) -> TailProbability:
    """The tail counted in `passes` plain passes (Clopper and Pearson)."""
    low, high = clopper_pearson(hits, passes)
    return TailProbability(margin_m_s, hits / passes, low, high, "plain simulation", passes)
