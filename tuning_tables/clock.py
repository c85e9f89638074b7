"""The clock of a regulator with a radar: how often it samples, and how soon its command reaches the valves."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated, Final

from tuning_tables.declared.members import require_declared
from tuning_tables.declared.numbers import Number

DELAY_RANGE_S: Final = (0.0, 2.0)


@dataclass(frozen=True)
class RegulatorClock:
    """The clock of the regulator that the table was made for; with another one its figures do not hold.

    Raises `InvalidTable`.

    Examples
    --------
    >>> from tuning_tables import RegulatorClock
    >>> RegulatorClock(sample_period_s=0.1, computing_delay_s=0.02).sample_period_s
    0.1
    """

    sample_period_s: Annotated[float, Number("time from sample to sample", 0.001, 2.0)]
    computing_delay_s: Annotated[
        float, Number("from the sample to the command on the wires of the valves", *DELAY_RANGE_S)
    ]

    def __post_init__(self) -> None:
        require_declared(self, "clock")

    def __str__(self) -> str:
        return in_words("sampled", self.sample_period_s, self.computing_delay_s)


def in_words(what: str, period_s: float, delay_s: float) -> str:
    """A clock for the eye: `what` it does every period, and how soon a command is on the wires."""
    return f"{what} every {period_s:g} s; a command is on the wires of the valves {delay_s:g} s later"
