"""What the trains of a trial have come to."""

from __future__ import annotations

from dataclasses import dataclass

from synth.hump.trains.outcomes import TrainOutcomes
from synth.hump.trains.resolved_trial import ResolvedTrial
from synth.hump.trains.train_figures import TrainFigure, train_figures
from synth.hump.trains.trial import HumpTrial


@dataclass(frozen=True)
class HumpedTrial:
    """`found`: the outcomes of all trains of `trial`, which was made of `config`; `figures`: what they tell."""

    config: ResolvedTrial
    trial: HumpTrial
    found: TrainOutcomes
    figures: tuple[TrainFigure, ...]

    def __repr__(self) -> str:
        return f"HumpedTrial({self.config.title}: {len(self.found)} trains, {int(self.found.cuts.sum())} cuts)"


def humped_trial(config: ResolvedTrial, trial: HumpTrial, found: TrainOutcomes) -> HumpedTrial:
    """The trains with their figures."""
    return HumpedTrial(config, trial, found, train_figures(found))
