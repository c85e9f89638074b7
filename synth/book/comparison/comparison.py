"""The closed loops of one case side by side, each by its role."""

from __future__ import annotations

from dataclasses import dataclass

from synth.book.comparison.measured import Measured


@dataclass(frozen=True)
class Comparison:
    """Our table and what it is compared with, all on the same passes.

    `friction_known`: the same kind of regulator, told the friction of every cut; `full_lines`: the solver's lines, not
    yet polynomials; `as_published`: lines of the formulation as published, with its own prediction; `baselines`: tuned
    classical laws; `without_estimator`: polished lines or surfaces for the measured speed, where an estimator was asked
    for; `at_rest`: where commands come at any time, the lines that the same tune makes for commands at rest.
    """

    table: Measured
    full_lines: Measured
    as_published: Measured
    friction_known: Measured
    baselines: tuple[Measured, ...]
    without_estimator: Measured | None = None
    at_rest: Measured | None = None

    @property
    def entries(self) -> tuple[Measured, ...]:
        """All controllers: the table first, the baselines last but for lines without estimator and those at rest."""
        last = (each for each in (self.without_estimator, self.at_rest) if each is not None)
        return (self.table, self.full_lines, self.as_published, self.friction_known, *self.baselines, *last)

    @property
    def best_baseline(self) -> Measured | None:
        """The baseline of least rms, None if there is none."""
        return min(self.baselines, key=lambda entry: entry.statistics.rms_m_s, default=None)

    @property
    def honesty(self) -> float:
        """Predicted rms / simulated rms of the table."""
        return self.table.honesty

    @property
    def regret(self) -> float:
        """rms of the table / rms of the friction-known bound."""
        return self.friction_known.table_ratio

    @property
    def table_loss(self) -> float:
        """rms of the table / rms of the full switching lines."""
        return self.full_lines.table_ratio
