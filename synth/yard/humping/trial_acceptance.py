"""Whether trains keep the limits of a configuration, given how exactly their figures are known."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from synth.configuration.humping.settings import TrialAcceptanceSettings
from synth.yard.humping.train_figures import TrainFigure


@dataclass(frozen=True)
class TrialVerdict:
    """Names of the figures that miss their limit, and of those whose interval holds it; a sentence on all."""

    missed: tuple[str, ...]
    undecided: tuple[str, ...]
    sentence: str

    @property
    def accepted(self) -> bool:
        """Every limit is kept, interval included."""
        return not (self.missed or self.undecided)


def judge_trains(figures: Sequence[TrainFigure], limits: TrialAcceptanceSettings) -> TrialVerdict:
    """The verdict on `figures`, each of which is looked for by its name."""
    given = limits.model_dump(exclude_none=True)
    if not given:
        return TrialVerdict((), (), "no limit is configured")
    told = {figure.name: figure for figure in figures}
    missed = tuple(name for name, limit in given.items() if told[name].low95 > limit)
    unknown = tuple(n for n, limit in given.items() if n not in missed and not told[n].high95 <= limit)
    parts = []
    for name, limit in given.items():
        word = "misses" if name in missed else "cannot be told from" if name in unknown else "keeps"
        figure = told[name]
        parts.append(f"{name} {figure.value:.4g} [{figure.low95:.4g}, {figure.high95:.4g}] {word} the limit {limit:g}")
    return TrialVerdict(missed, unknown, "; ".join(parts))
