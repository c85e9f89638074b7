"""What the trains of a trial have come to."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

from synth.hump.trains.outcomes import TrainOutcomes
from synth.hump.trains.resolved_trial import ResolvedTrial
from synth.hump.trains.train_figures import TrainFigure, train_figures
from synth.hump.trains.trial import HumpTrial


@dataclass(frozen=True)
class HumpedTrial:
    """`found`: the outcomes of all trains of `trial`, which was made of `config`."""

    config: ResolvedTrial
    trial: HumpTrial
    found: TrainOutcomes

    def __repr__(self) -> str:
        return f"HumpedTrial({self.config.title}: {len(self.found)} trains, {int(self.found.cuts.sum())} cuts)"

    @cached_property
    def figures(self) -> tuple[TrainFigure, ...]:
        """What the outcomes tell."""
        return train_figures(self.found)
