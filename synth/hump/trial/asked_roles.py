"""Which roles and exit speeds a configuration asks of the positions of a hump."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import replace
from typing import Final

import numpy as np

from plant_models.errors import PlantError, require
from plant_models.frozen_arrays import Bools
from plant_models.library import SourcedValue, WeightCategories
from synth.frame.printed_numbers import ranges
from synth.frame.settings.numbers import sourced
from synth.hump.configuration.sections import ALL, EXIT_RANGE_M_S, USUAL_RANGE, HumpPositionSettings, RoleName
from synth.hump.planning.forecast import SpeedRange
from synth.hump.planning.position_roles import Exits, Fixed, Roles, Spacing
from synth.hump.rolling.hump_routes import HumpRoutes
from synth.hump.trial.position_choice import PositionChoice

UNBRAKED_M_S: Final = 99.0
"""An exit speed that no cut has: whoever asks for it leaves the brake open."""

OF_EXITS: Final = ("lowest_m_s", "highest_m_s", "most_entry_m_s")
"""Keys that say nothing of a position that aims."""

Asked = Sequence[HumpPositionSettings]
"""The settings of each position, in order from the crest."""

Where = Callable[[Bools, Bools], Bools]
"""On which routes a position aims, of (those whose last position it is, those with a switch behind the last)."""

AIMS: Final[Mapping[RoleName | None, Where]] = {
    None: lambda last, parts: last & ~parts,
    "aim": lambda last, parts: last,
    "spacing": lambda last, parts: last & False,
    "fixed": lambda last, parts: last & False,
}


def settings_of(count: int, given: Sequence[HumpPositionSettings]) -> tuple[HumpPositionSettings, ...]:
    """Those of `count` positions in order from the crest, of which `given` tell some."""
    told = {each.number: each for each in given}
    return tuple(told.get(n, HumpPositionSettings(number=n)) for n in range(1, count + 1))


def asked_roles(
    asked: Asked, choices: Sequence[PositionChoice], routes: HumpRoutes, categories: WeightCategories, compared: int
) -> Roles:
    """The roles; so many exit speeds are `compared` in a position. `PlantError` tells the key at fault."""
    numbers = np.arange(1, routes.positions + 1)[:, None]
    held, last = routes.positions_of >= numbers, routes.positions_of == numbers
    aims = np.zeros(held.shape, dtype=bool)
    for place, each in enumerate(asked):
        aims[place] = AIMS[each.role_name](last[place], routes.parts_behind)
        require(
            each.role != "aim" or bool(last[place].any()),
            f"position {each.number}: role is 'aim', but on every route there is another position behind it, which has "
            "to aim; give that one the role",
        )
    exits = tuple(
        aiming(each) if (aims[place] == held[place]).all() else exits_of(each, choice, compared, categories)
        for place, (each, choice) in enumerate(zip(asked, choices, strict=True))
    )
    return Roles(exits, aims, held)


def aiming(asked: HumpPositionSettings) -> Exits:
    """Stands for the exits of a position that aims all cuts; `PlantError` where the user gives some."""
    given = next((key for key in OF_EXITS if getattr(asked, key) is not None), None)
    require(
        given is None,
        f"position {asked.number}: {given} is {getattr(asked, given or 'number')}, but the position aims on every "
        'route, by [aim]; take it out, or give the position role = "spacing"',
    )
    return Spacing(SpeedRange(*EXIT_RANGE_M_S, 1))


def exits_of(asked: HumpPositionSettings, choice: PositionChoice, choices: int, categories: WeightCategories) -> Exits:
    """What a position does with cuts that it does not aim."""
    entry = np.inf if asked.most_entry_m_s is None else asked.most_entry_m_s
    if choice.out_of_service:
        return Spacing(SpeedRange(UNBRAKED_M_S, UNBRAKED_M_S, 1))
    if asked.exit_m_s is not None:
        return Fixed(np.array(fixed_speeds(asked, categories)), entry)
    low, high = exit_range(asked, choice)
    return Spacing(SpeedRange(low, high, choices if low < high else 1, entry))


def fixed_speeds(asked: HumpPositionSettings, categories: WeightCategories) -> list[float]:
    """The fixed exit speed of each weight category; `PlantError` for an unknown one, and for one that has none."""
    given = dict(asked.exit_m_s or {})
    key, of_others = f"position {asked.number}: exit_m_s", given.pop(ALL, None)
    found: dict[int, float] = {}
    for name, speed in given.items():
        try:
            member = categories.named(name)
        except PlantError as fault:
            raise PlantError(f"{key}: {fault}") from None
        require(member.number not in found, f"{key}: {name} is there twice; leave one out")
        found[member.number] = speed
    left = [member.latin for member in categories.members if member.number not in found]
    require(
        not left or of_others is not None,
        f"{key} has no speed for {', '.join(left)}; add {left[0] if left else ''}, or {ALL} for all that are not named",
    )
    return [found.get(member.number, of_others or 0.0) for member in categories.members]


def exit_range(asked: HumpPositionSettings, choice: PositionChoice) -> tuple[float, float]:
    """Lowest and highest exit speed of a position that keeps cuts apart. An end that is not asked for is the usual one,
    or, within it, that of the book; where then nothing is left to choose from, the book does not fit."""
    low = EXIT_RANGE_M_S[0] if asked.lowest_m_s is None else asked.lowest_m_s
    high = max(EXIT_RANGE_M_S[1], low) if asked.highest_m_s is None else asked.highest_m_s
    low = min(low, high) if asked.lowest_m_s is None else low
    if choice.held is None:
        return low, high
    in_book = choice.held.within(low, high)
    found = (in_book[0] if asked.lowest_m_s is None else low, in_book[1] if asked.highest_m_s is None else high)
    return found if found[0] < found[1] else (low, high)


def role_warnings(asked: Asked, roles: Roles, routes: HumpRoutes) -> Iterator[str]:
    """A sentence for each role that does what hardly anybody wants."""
    for place, each in enumerate(asked):
        blocked = sorted(int(track) for track in routes.tracks[roles.aims[place] & routes.parts_behind])
        if blocked:
            yield (
                f"position {each.number} aims at the standing cars of tracks {ranges(blocked)}, and switches are "
                "behind it: cuts leave it slowly and block them, so that those behind catch up"
            )


def role_values(asked: Asked, roles: Roles, categories: WeightCategories) -> Iterator[SourcedValue]:
    """Every exit speed, with its origin."""
    fields = HumpPositionSettings.model_fields
    for place, (each, exits) in enumerate(zip(asked, roles.exits, strict=True)):
        key = f"position.{each.number}"
        if place not in roles.not_of_all:
            continue
        match exits:
            case Fixed():
                for member, speed in zip(categories.members, exits.speed_m_s, strict=True):
                    yield sourced(f"{key}.exit_m_s.{member.latin}", float(speed), fields["exit_m_s"])
            case Spacing(SpeedRange(low, high)) if low < UNBRAKED_M_S:
                for name, speed in (("lowest_m_s", low), ("highest_m_s", high)):
                    value = sourced(f"{key}.{name}", speed, fields[name])
                    yield value if getattr(each, name) is not None else replace(value, source=USUAL_RANGE)
        if each.most_entry_m_s is not None:
            yield sourced(f"{key}.most_entry_m_s", each.most_entry_m_s, fields["most_entry_m_s"])
