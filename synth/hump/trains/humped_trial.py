"""What the trains of a trial have come to, and whether its plan has failed: the limits of a configuration, given how
exactly the figures of its trains are known.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Final

from synth.frame.command import Limit
from synth.frame.printed_numbers import ranges
from synth.hump.rolling.outcomes import TrainOutcomes, caught_at
from synth.hump.trains.train_figures import TrainFigure, strengths, train_figures, weak
from synth.hump.trial.resolved_trial import ResolvedTrial
from synth.hump.trial.trial import HumpTrial


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


JUDGES_NOTHING: Final = 1.0
"""A limit that every share keeps."""


def trial_limits(result: HumpedTrial) -> Iterator[Limit]:
    """Each limit with the figure that has its name; None where the interval of the figure holds the limit."""
    told, speeds = {figure.name: figure for figure in result.figures}, result.trial.couplings
    words = {
        "catch_ups": "cuts that caught up",
        "overspeed": f"couplings above {speeds.allowed_m_s:.3g} m/s",
        "overspeed_harmful": f"couplings above {speeds.harmful_m_s:.3g} m/s",
    }
    for name, limit in result.config.settings.acceptance.model_dump(exclude_none=True).items():
        if limit < JUDGES_NOTHING:
            yield limit_of(words[name], told[name], limit, result)


def limit_of(what: str, figure: TrainFigure, limit: float, result: HumpedTrial) -> Limit:
    """One limit, on `what` the figure tells; where it is not kept, the sentence says what it comes from."""
    kept = kept_within(figure, limit)
    shares = (f"{100.0 * each:.3g}" for each in (figure.value, figure.low95, figure.high95))
    sentence = "{}: {} % [{}, {}]".format(what, *shares)
    sentence += f", at most {100.0 * limit:.3g} % allowed"
    if kept is None:
        return Limit(f"{sentence}; these trains are too few to tell", None)
    reasons = [] if kept else [said for reason in REASONS[figure.name] if (said := reason(result))]
    return Limit("; ".join((sentence, *reasons)), kept)


def kept_within(figure: TrainFigure, limit: float) -> bool | None:
    """Whether a figure keeps the limit, interval included; None where the interval holds it, where there is none, and
    where the limit judges nothing."""
    if limit >= JUDGES_NOTHING:
        return None
    return False if figure.low95 > limit else True if figure.high95 <= limit else None


def where_caught(result: HumpedTrial) -> str:
    """The element at which most cuts caught up."""
    routes = result.config.routes
    counts = caught_at(routes, result.found)
    if not counts.any():
        return ""
    worst = int(counts.argmax())
    return (
        f"{100.0 * counts[worst] / counts.sum():.0f} % of them at {routes.graph.element_called(routes.numbers[worst])}"
    )


def not_aimed(result: HumpedTrial) -> str:
    """The tracks on which nothing brakes cuts for the standing cars."""
    aims = result.config.roles.aims.any(axis=0)
    tracks = sorted(int(track) for track in result.config.routes.tracks[~aims])
    if not tracks:
        return ""
    skates = result.config.settings.tracks.skates_share
    held = f"cuts couple with what skates leave of their speed, which take {100.0 * skates:.3g} % of the energy"
    free = "cuts couple as fast as they come there (where skates are laid, set tracks.skates_share)"
    return (
        f"on tracks {ranges(tracks)} no position aims at the standing cars: {held if skates > 0.0 else free}; "
        "acceptance.overspeed = 1 judges no couplings"
    )


def too_weak(result: HumpedTrial) -> str:
    """The positions whose brake is too weak for these trains."""
    told = (
        f"position {number} let {100.0 * each.value:.3g} % of its cuts go too fast for want of brake"
        for number, each in enumerate(strengths(result.found), start=1)
        if weak(each)
    )
    return "; ".join(told)


REASONS: Final[Mapping[str, tuple[Callable[[HumpedTrial], str], ...]]] = {
    "catch_ups": (where_caught, too_weak),
    "overspeed": (not_aimed, too_weak),
    "overspeed_harmful": (not_aimed, too_weak),
}
"""What a missed limit may come from."""
