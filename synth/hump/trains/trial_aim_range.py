"""Which exit speeds a position may aim with: those of [aim], as far as the book of the position has tables for them."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from synth.hump.configuration.settings import TrialAimSettings
from synth.hump.trains.position_choice import PositionChoice
from synth.hump.trains.position_roles import Roles


def aim_range_m_s(aim: TrialAimSettings, choice: PositionChoice) -> tuple[float, float]:
    """Lowest and highest exit speed. A closed loop takes commands beyond its targets for the nearest one, so none is
    chosen there; where [aim] and the book have no speed in common, it is the end of the book that is nearest."""
    if choice.held is None or choice.out_of_service:
        return aim.lowest_m_s, aim.highest_m_s
    low, high = (
        min(max(speed, choice.held.lowest_m_s), choice.held.highest_m_s) for speed in (aim.lowest_m_s, aim.highest_m_s)
    )
    return low, high


def book_warnings(choices: Sequence[PositionChoice], roles: Roles, aim: TrialAimSettings) -> Iterator[str]:
    """A sentence for each position whose book keeps it from aiming as slowly, or as fast, as [aim] asks for."""
    for place, choice in enumerate(choices):
        asked, found = (aim.lowest_m_s, aim.highest_m_s), aim_range_m_s(aim, choice)
        less = found[0] > asked[0] or ("highest_m_s" in aim.model_fields_set and found[1] < asked[1])
        if less and roles.aims[place].any():
            yield (
                f"position {choice.number} aims with {found[0]:g} to {found[1]:g} m/s, for which its book has tables; "
                f"[aim] allows {asked[0]:g} to {asked[1]:g} m/s"
            )
