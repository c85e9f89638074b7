"""What a book of tables must have for the cuts of a trial and for the exit speeds that a position may be commanded."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np

from plant_models.library import WeightCategories
from plant_models.rolling.random_cuts import CutPopulation
from synth.hump.configuration.sections import HumpPositionSettings
from synth.hump.control.cut_record import SortingList
from synth.hump.control.train_population import TrainPopulation
from synth.hump.planning.position_roles import Fixed, Roles
from synth.hump.rolling.table_hump_position import MOST_LONGER, MOST_SHORTER, nearest_axles
from synth.hump.trial.position_choice import HeldTables, PositionChoice

Kind = tuple[int, int]
"""Cuts that a class must stand for: place of the weight category, and axles."""

COMMAND: Final = "retarder-synth init --for"
"""What writes the configuration of a book that fits."""


@dataclass(frozen=True)
class NeededTables:
    """What the tables of one position must be for.

    `kinds`: of all cuts that trains can have. `lowest_m_s` to `highest_m_s`: exit speeds that may be commanded, which
    `words` tells; None of a position that aims all its cuts, for an aim keeps to the speeds that its book has.
    """

    kinds: frozenset[Kind]
    lowest_m_s: float | None
    highest_m_s: float | None
    words: str

    def missing_kinds(self, held: HeldTables, categories: WeightCategories) -> set[Kind]:
        """The cuts for which no class of the book stands."""
        names = [member.name for member in categories.members]
        return {
            (place, axles)
            for place, axles in self.kinds
            if nearest_axles([count for name, count in held.kinds if name == names[place]], axles) is None
        }

    def missing_targets(self, held: HeldTables) -> str | None:
        """Where the book begins or ends within the exit speeds that may be commanded, in words; None if it does not."""
        if self.lowest_m_s is None or self.highest_m_s is None:
            return None
        begins, ends = held.lowest_m_s > self.lowest_m_s, held.highest_m_s < self.highest_m_s
        if begins and ends:
            return f"has tables from {held.lowest_m_s:g} to {held.highest_m_s:g} m/s alone"
        if begins:
            return f"begins at {held.lowest_m_s:g} m/s"
        return f"ends at {held.highest_m_s:g} m/s" if ends else None


def needed_tables(
    asked: Sequence[HumpPositionSettings], roles: Roles, trains: TrainPopulation | SortingList, people: CutPopulation
) -> tuple[NeededTables, ...]:
    """Of every position, in order from the crest; `asked`: their settings."""
    kinds = kinds_of_cuts(trains, people)
    return tuple(needed_at(place, each, roles, kinds) for place, each in enumerate(asked))


def needed_at(place: int, asked: HumpPositionSettings, roles: Roles, kinds: frozenset[Kind]) -> NeededTables:
    """Of the position at `place`."""
    exits = roles.exits[place]
    if place not in roles.not_of_all:
        return NeededTables(kinds, None, None, "it aims at the standing cars")
    if isinstance(exits, Fixed):
        low, high = float(exits.speed_m_s.min()), float(exits.speed_m_s.max())
        return NeededTables(kinds, low, high, f"exit_m_s of the position commands {speeds(low, high)}")
    low, high = exits.range.low_m_s, exits.range.high_m_s
    given = [key for key in ("lowest_m_s", "highest_m_s") if getattr(asked, key) is not None]
    origin = (
        f"by its {' and '.join(given)}" if given else "which are usual where lowest_m_s and highest_m_s are left out"
    )
    return NeededTables(kinds, low, high, f"it keeps cuts apart with {speeds(low, high)}, {origin}")


def speeds(low_m_s: float, high_m_s: float) -> str:
    """A range of exit speeds in words."""
    return f"{low_m_s:g} m/s" if low_m_s == high_m_s else f"{low_m_s:g} to {high_m_s:g} m/s"


def kinds_of_cuts(trains: TrainPopulation | SortingList, people: CutPopulation) -> frozenset[Kind]:
    """All kinds of cuts that trains can have; the cars of a cut may have different numbers of axles."""
    members = people.categories.members
    if isinstance(trains, SortingList):
        numbers = [member.number for member in members]
        return frozenset((numbers.index(cut.category), cut.axles) for cut in trains.cuts)
    found: set[Kind] = set()
    for place, member in enumerate(members):
        if trains.category_shares.get(member.number, 0.0) > 0.0:
            of_cars = np.unique(people.mix.of(people.categories, member).axles).tolist()
            sums = {0}
            for _ in range(trains.most_cars):
                sums = {axles + more for axles in sums for more in of_cars}
                found |= {(place, axles) for axles in sums}
    return frozenset(found)


def unfitting_tables(
    place: str,
    choices: Sequence[PositionChoice],
    needs: Sequence[NeededTables],
    trains: TrainPopulation | SortingList,
    people: CutPopulation,
) -> Iterator[str]:
    """A sentence for each thing that the book of a position in service lacks; `place`: what messages call the trial."""
    for choice, need in zip(choices, needs, strict=True):
        held = choice.held
        if held is None or choice.out_of_service:
            continue
        named = f"{place}: position {choice.number}: its book {choice.book}"
        remedy = f"make one that fits by '{COMMAND} {place} --position-number {choice.number} > tables.toml'"
        missing = need.missing_kinds(held, people.categories)
        if missing:
            lacking = lacking_classes(missing, held, people.categories)
            yield f"{named} {lacking}: {remedy}, {or_fewer(missing, trains, people)}"
        targets = need.missing_targets(held)
        if targets is not None:
            within = f"within {speeds(held.lowest_m_s, held.highest_m_s)} (lowest_m_s and highest_m_s, or exit_m_s)"
            yield f"{named} {targets}, but {need.words}: {remedy}, or give the position exit speeds {within}"


def lacking_classes(missing: Collection[Kind], held: HeldTables, categories: WeightCategories) -> str:
    """Which cuts have no class, and which classes there are."""
    members = categories.members
    labels = {each.name: each.label for each in members}
    there = with_axles((labels.get(name, name), axles) for name, axles in sorted(held.kinds))
    wanted = with_axles((members[place].label, axles) for place, axles in sorted(missing))
    return (
        f"has no class for cuts of category {wanted}; a class stands for cuts of its category with 1/{MOST_SHORTER:g} "
        f"to {MOST_LONGER:.2f} times its axles, and there are {there}"
    )


def with_axles(kinds: Iterator[tuple[str, int]]) -> str:
    """Categories with numbers of axles in words."""
    counts: dict[str, list[int]] = {}
    for name, axles in kinds:
        counts.setdefault(name, []).append(axles)
    return "; ".join(f"{name} with {', '.join(map(str, axles))} axles" for name, axles in counts.items())


def or_fewer(missing: Collection[Kind], trains: TrainPopulation | SortingList, people: CutPopulation) -> str:
    """What a user may set so that trains have none of the kinds of cuts that are `missing`."""
    if isinstance(trains, SortingList):
        return "or take a list without them"
    members = people.categories.members
    longest = {place: int(people.mix.of(people.categories, members[place]).axles.max()) for place, _ in missing}
    without = {place for place, axles in missing if axles <= longest[place]}
    remedies = []
    if without:
        names = ", ".join(members[place].latin for place in sorted(without))
        remedies.append(f"leave {names} out of trains.category_shares")
    if without != set(longest):
        most = min((axles - 1) // longest[place] for place, axles in missing if place not in without)
        remedies.append(f"set trains.most_cars = {most}")
    return f"or {' and '.join(remedies)}"
