"""What is known of a cut in the retarder: the places of the state that `observe` carries from sample to sample."""

from __future__ import annotations

from typing import Annotated, Final, TypeAlias

import numpy as np
import numpy.typing as npt

from tuning_tables.language.records import Record, real

(
    BEGUN, PATH_M, SPEED_M_S, FACTOR, EXCESS, SPEED_VARIANCE, FACTOR_COVARIANCE, EXCESS_COVARIANCE, FACTOR_VARIANCE,
    CROSS_COVARIANCE, EXCESS_VARIANCE, UNSEEN, READING_M_S, REPEATED, BELIEVED, DOUBTED,
) = range(16)  # fmt: skip

ESTIMATE: Final = Record(
    "estimate",
    "What is known of the cut in the retarder. Closed: all 0 before its first sample, one for each cut.",
    {
        "begun": real("0: no speed was measured yet; 1"),
        "path_m": real("of the last sample, m"),
        "speed_m_s": real("m/s"),
        "factor": real("of the friction of this cut"),
        "excess": real("of its running resistance over the mean, m/s2"),
        "speed_variance": real("m2/s2"),
        "factor_covariance": real("of speed and factor"),
        "excess_covariance": real("of speed and excess"),
        "factor_variance": real("of the factor"),
        "cross_covariance": real("of factor and excess"),
        "excess_variance": real("of the excess"),
        "unseen": real("samples since the last reading that was believed"),
        "reading_m_s": real("the last that can be true, m/s"),
        "repeated": real("how often it was the same again"),
        "believed": real("readings since the estimate began"),
        "doubted": real("readings in a row"),
    },
    is_state=True,
)

Estimate: TypeAlias = Annotated[npt.NDArray[np.float32], ESTIMATE]
"""float32 (16,)."""
