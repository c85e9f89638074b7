"""The elements of a hump that a short file describes: how its tracks part, at levels that are the same on every way,
numbers, places, and which leads to which.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Final

from plant_models.hump import RETARDERS, SECTIONS, SIGNALS
from synth.hump.making.short_hump import ShortHump


@dataclass(frozen=True)
class Leaf:
    """The way is that of one track."""

    track: int


@dataclass(frozen=True)
class Fork:
    """A switch of the `level`, 0 for the first behind the crest, and what lies to the left and to the right."""

    level: int
    left: Tree
    right: Tree


Tree = Leaf | Fork


def track_tree(bunches: Sequence[int]) -> Tree:
    """Tracks from 1 on, from the left: the first levels part the bunches, those behind them the tracks of each; the
    left side of a fork has the one that is odd."""
    first_level = levels_of(len(bunches))
    begins = [1 + sum(bunches[:place]) for place in range(len(bunches))]
    inner = [
        parted([Leaf(track) for track in range(begin, begin + size)], first_level)
        for begin, size in zip(begins, bunches, strict=True)
    ]
    return parted(inner, 0)


def parted(trees: Sequence[Tree], level: int) -> Tree:
    """One tree of `trees`, whose first fork is of `level`."""
    if len(trees) == 1:
        return trees[0]
    middle = (len(trees) + 1) // 2
    return Fork(level, parted(trees[:middle], level + 1), parted(trees[middle:], level + 1))


def levels_of(count: int) -> int:
    """Levels of forks that part so many."""
    return (count - 1).bit_length()


def levels_needed(bunches: Sequence[int]) -> int:
    """Levels of the tree of `bunches`."""
    return levels_of(len(bunches)) + max(map(levels_of, bunches))


DIGITS: Final = 6
"""Of lengths, so that they keep no noise of differences."""

TEN: Final = 10
"""Numbers of a position begin with the next ten, where there are enough of them."""


@dataclass(frozen=True)
class PlannedEdge:
    """Track to the element `to`, None to the end; behind a last switch it turns back by `turn_back_deg`, to the left
    positive, from `curve_m[0]` to `curve_m[1]`."""

    to: int | None
    length_m: float
    turn_back_deg: float = 0.0
    curve_m: tuple[float, float] = (0.0, 0.0)


@dataclass(frozen=True)
class Planned:
    """An element: `kind` as in a hump file, `of` the number of its position or track (from 1), 0 for others."""

    kind: str
    number: int
    at_m: float
    edges: tuple[PlannedEdge, ...]
    of: int = 0


@dataclass(frozen=True)
class HumpPlan:
    """The plan of `short`, which must keep the rules."""

    short: ShortHump

    @cached_property
    def tree(self) -> Tree:
        """How the tracks part."""
        return track_tree(self.short.of_bunches)

    @cached_property
    def switch_numbers(self) -> dict[int, int]:
        """Number of the switch of each fork, by its identity: level by level, from the left."""
        forks = sorted(forks_of(self.tree), key=lambda fork: fork.level)
        return {id(fork): number for number, fork in enumerate(forks, start=1)}

    @cached_property
    def order(self) -> tuple[int, ...]:
        """Places of the positions in the short file, from the crest on."""
        places = range(len(self.short.position))
        return tuple(sorted(places, key=lambda place: self.short.position[place].from_m))

    @cached_property
    def retarder_numbers(self) -> tuple[range, ...]:
        """Numbers of the retarders of each position, from the crest on."""
        counts = [self.branches_at(self.tree, self.short.position[place].from_m) for place in self.order]
        return numbered(counts, TEN) or numbered(counts, 1) or tuple(range(0) for _ in counts)

    @property
    def retarders(self) -> int:
        """How many there are."""
        return sum(self.branches_at(self.tree, each.from_m) for each in self.short.position)

    def branches_at(self, tree: Tree, at_m: float) -> int:
        """How many tracks lie side by side `at_m` from the crest, in this part of the tree."""
        if isinstance(tree, Leaf) or self.short.switches_m[tree.level] > at_m:
            return 1
        return self.branches_at(tree.left, at_m) + self.branches_at(tree.right, at_m)

    def elements(self) -> Iterator[Planned]:
        """All elements, the signal at the crest first."""
        taken = [iter(numbers) for numbers in self.retarder_numbers]
        inner: list[Planned] = []
        first = self.grown(self.tree, 0.0, 0.0, taken, inner)
        yield Planned("signal", SIGNALS.first, 0.0, (self.edge_to(0.0, first, 0.0, 0.0),))
        yield from inner

    def grown(
        self, tree: Tree, begin_m: float, turned_deg: float, taken: Sequence[Iterator[int]], made: list[Planned]
    ) -> Planned:
        """Add to `made` what stands from `begin_m` on where the way is that of `tree`, and return the first of it.

        `turned_deg`: of the switches so far. `taken`: the numbers that are left of each position.
        """
        ends_m = self.short.tracks_from_m if isinstance(tree, Leaf) else self.short.switches_m[tree.level]
        here = [
            (rank, self.short.position[place].from_m)
            for rank, place in enumerate(self.order)
            if begin_m < self.short.position[place].from_m < ends_m
        ]
        numbers = [next(taken[rank]) for rank, _ in here]
        behind = self.track(tree) if isinstance(tree, Leaf) else self.switch(tree, turned_deg, taken, made)
        if isinstance(tree, Leaf):
            made.append(behind)
        for (rank, at), number in zip(reversed(here), reversed(numbers), strict=True):
            behind = Planned("retarder", number, at, (self.edge_to(at, behind, 0.0, 0.0),), rank + 1)
            made.append(behind)
        return behind

    def switch(self, fork: Fork, turned_deg: float, taken: Sequence[Iterator[int]], made: list[Planned]) -> Planned:
        """The switch of `fork`, added to `made` behind what stands behind it."""
        at, turn = self.short.switches_m[fork.level], self.short.turn_deg
        edges = []
        for side, turns in ((fork.left, turn), (fork.right, -turn)):
            behind = self.grown(side, at, turned_deg + turns, taken, made)
            back = -(turned_deg + turns) if isinstance(side, Leaf) and self.short.parallel_tracks else 0.0
            edges.append(self.edge_to(at, behind, back, self.short.section_behind_m))
        switch = Planned("switch", self.switch_numbers[id(fork)], at, tuple(edges))
        made.append(switch)
        return switch

    def track(self, leaf: Leaf) -> Planned:
        """The section of a track."""
        edge = PlannedEdge(None, self.short.track_length_m)
        return Planned("section", SECTIONS.first + leaf.track - 1, self.short.tracks_from_m, (edge,), leaf.track)

    def edge_to(self, at_m: float, behind: Planned, turn_back_deg: float, from_m: float) -> PlannedEdge:
        """From `at_m` to the element `behind`; the curve lies between the sections of both."""
        length = round(behind.at_m - at_m, DIGITS)
        ends_m = round(length - self.ahead_m(behind), DIGITS)
        return PlannedEdge(behind.number, length, round(turn_back_deg, DIGITS), (from_m, ends_m))

    def ahead_m(self, element: Planned) -> float:
        """How far its insulated section reaches ahead of it."""
        if element.kind == "switch":
            return self.short.section_ahead_m
        return self.short.position[self.order[element.of - 1]].margin_m if element.kind == "retarder" else 0.0


def forks_of(tree: Tree) -> Iterator[Fork]:
    """All forks, those of one level from the left."""
    if isinstance(tree, Fork):
        yield tree
        yield from forks_of(tree.left)
        yield from forks_of(tree.right)


def numbered(counts: Sequence[int], step: int) -> tuple[range, ...]:
    """Numbers of retarders for positions of so many, each from the next multiple of `step` on; () where they are not
    enough."""
    found: list[range] = []
    begin = RETARDERS.first
    for count in counts:
        found.append(range(begin, begin + count))
        begin = RETARDERS.first + -(-(begin + count - RETARDERS.first) // step) * step
    return tuple(found) if not found or found[-1].stop - 1 <= RETARDERS.last else ()
