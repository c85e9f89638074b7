"""Which curves are compared: what control, exactness and regulators bring."""

from __future__ import annotations

from scripts.studies.humping.closed_loops import REGULATED, REGULATORS, TABLES, ClosedLoops
from scripts.studies.humping.frontier import (
    CONTROLS,
    OPEN_LOOP,
    WITH_FEEDBACK,
    WITH_MEASURED,
    WITH_SLOWING,
    Frontier,
    Gain,
    Line,
    sigma,
)

Compared = tuple[Line, Line]
"""A curve and the one that it is compared with."""


def normal_gains(frontier: Frontier, stds_m_s: tuple[float, ...]) -> tuple[Gain, ...]:
    """What feedback, measured resistance and exactness bring, at every limit."""
    best, worst = min(stds_m_s), max(stds_m_s)
    named = [sigma(std) for std in stds_m_s]
    pairs = [((name, WITH_FEEDBACK), (name, OPEN_LOOP)) for name in named]
    pairs += [((name, WITH_MEASURED), (name, WITH_FEEDBACK)) for name in named]
    pairs += [((name, WITH_SLOWING), (name, WITH_FEEDBACK)) for name in named]
    pairs += [((sigma(best), control), (sigma(worst), control)) for control in CONTROLS if best < worst]
    return gains(frontier, pairs)


def table_gains(frontier: Frontier, loops: ClosedLoops) -> tuple[Gain, ...]:
    """What our tables bring beside normal positions and other regulators, and what feedback brings with them; what
    their commands cost exact positions."""
    others = [*map(sigma, sorted(loops.stds_m_s, reverse=True)), *(name for name in REGULATORS if name != TABLES)]
    pairs = [((TABLES, control), (other, control)) for control in REGULATED for other in others]
    pairs += [((TABLES, WITH_FEEDBACK), (loops.commanded, WITH_FEEDBACK))]
    pairs += [((loops.commanded, WITH_FEEDBACK), (loops.best, WITH_FEEDBACK))]
    pairs += [((TABLES, WITH_FEEDBACK), (TABLES, OPEN_LOOP)), ((TABLES, WITH_SLOWING), (TABLES, WITH_FEEDBACK))]
    return gains(frontier, pairs)


def gains(frontier: Frontier, pairs: list[Compared]) -> tuple[Gain, ...]:
    """Of all pairs at every limit."""
    return tuple(frontier.gain(more, than, limit) for limit in frontier.limits for more, than in pairs)
