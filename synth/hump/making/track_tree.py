"""How the tracks of a hump part: a tree of forks, one a switch, at levels that are the same on every way."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass


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
