"""What the slow simulator refuses, because the model of humping does not speak of it."""

from __future__ import annotations

from plant_models.hump import Retarder, Route
from tests.synth.hump.trains.slow_train import SlowCut


def require_fit(cut: SlowCut, route: Route, free_to_m: float) -> None:
    """Raise `ValueError` for a cut or a track of which the model does not speak."""
    positions = [(e.at_m, e.at_m + e.vertex.exit_m) for e in route.elements if isinstance(e.vertex, Retarder)]
    if len(cut.exit_speeds_m_s) < len(positions) or 0 < len(cut.brake_heads_m) < len(positions):
        raise ValueError(f"track {route.track}: {len(positions)} positions, and fewer commands or heads")
    if any(speed <= 0.0 for speed in (*cut.exit_speeds_m_s, cut.hump_speed_m_s)):
        raise ValueError("speeds of the hump and commands must be more than 0")
    ends = [0.5 * cut.body.length_m - cut.body.first_axle_m, *(end + cut.body.base_m for _, end in positions)]
    if any(end >= begin for end, (begin, _) in zip(ends, positions, strict=False)):
        raise ValueError(f"track {route.track}: the cut is longer than the way between two positions")
    if not route.elements[-1].from_m < free_to_m <= route.length_m:
        raise ValueError(f"track {route.track}: cars stand at {free_to_m:g} m; it must be on the last section")
