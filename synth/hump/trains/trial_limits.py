"""Whether trains keep the limits of a configuration, given how exactly their figures are known."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from synth.frame.command import Limit
from synth.hump.configuration.settings import TrialAcceptanceSettings
from synth.hump.trains.train_figures import TrainFigure

WORDS = {True: "keeps", False: "misses", None: "cannot be told from"}


def trial_limits(figures: Sequence[TrainFigure], limits: TrialAcceptanceSettings) -> Iterator[Limit]:
    """Each limit that is set, with the one of `figures` that has its name; None where its interval holds the limit."""
    told = {figure.name: figure for figure in figures}
    for name, limit in limits.model_dump(exclude_none=True).items():
        figure = told[name]
        kept = False if figure.low95 > limit else True if figure.high95 <= limit else None
        interval = f"{figure.value:.4g} [{figure.low95:.4g}, {figure.high95:.4g}]"
        yield Limit(f"{name} {interval} {WORDS[kept]} the limit {limit:g}", kept)
