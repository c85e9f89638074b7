"""What a yard master asks first: how many cars, how often a cut catches up, how hard cuts couple, where it is tight."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence

import numpy as np

from plant_models.frozen_arrays import Ints
from synth.frame.exhibits import Column, Exhibit, Row, Sentence, Table, Tile, Tiles
from synth.frame.printed_numbers import decimals, three_figures
from synth.hump.rolling.outcomes import caught_at
from synth.hump.trains.humped_trial import HumpedTrial, kept_within
from synth.hump.trains.shown.positions import role_words
from synth.hump.trains.train_figures import TrainFigure, interval_of, ratio, shift_sums

KM_H = 3.6
"""Kilometres an hour in a metre a second."""

MOST_PLACES = 3
"""Places and pairs that are told, the most frequent first."""

CLOSEST = (
    "Closest are the two cuts of a train with the least time between the last axle of the one ahead out of an element "
    "and the first axle of the next one in, less what the points need. A program of speeds is as fast as this allows."
)


def first_screen(result: HumpedTrial) -> Iterator[Exhibit]:
    """Four tiles; where cuts caught up, and where they came closest; the exit speeds that were commanded."""
    told = {figure.name: figure for figure in result.figures}
    yield Tiles((cars_tile(told), caught_tile(told, result), couplings_tile(told, result), gap_tile(told)))
    yield Sentence(where_caught(result))
    yield Sentence(f"{where_closest(result)} {CLOSEST}")
    yield exits_table(result)


def cars_tile(told: dict[str, TrainFigure]) -> Tile:
    """How many cars come over the hump."""
    cars, speed = told["cars_per_hour"], told["hump_speed"]
    return Tile(f"{cars.value:.0f}", f"cars an hour{between(cars, '.0f')}, pushed at {speed.value:.2f} m/s on average")


def caught_tile(told: dict[str, TrainFigure], result: HumpedTrial) -> Tile:
    """How rarely a cut catches up, in cuts."""
    caught, limit = told["catch_ups"], result.config.settings.acceptance.catch_ups
    most = f"; at most one in {one_in(caught.high95)}" if math.isfinite(caught.high95) else ""
    head = f"one cut in {one_in(caught.value)}" if caught.value > 0.0 else f"none of {caught.n:,} cuts"
    return Tile(head, f"caught up with the cut ahead{most}", kept_within(caught, limit))


def couplings_tile(told: dict[str, TrainFigure], result: HumpedTrial) -> Tile:
    """How many cuts couple too fast, and how many do harm."""
    over, harmful, limits = told["overspeed"], told["overspeed_harmful"], result.trial.couplings
    kept = kept_within(over, result.config.settings.acceptance.overspeed or 1.0)
    return Tile(
        f"{three_figures(100.0 * over.value)} %",
        f"of the cuts couple faster than {limits.allowed_m_s:.3g} m/s ({KM_H * limits.allowed_m_s:.3g} km/h); "
        f"{three_figures(100.0 * harmful.value)} % faster than {limits.harmful_m_s:.3g} m/s "
        f"({KM_H * limits.harmful_m_s:.3g} km/h)",
        kept,
    )


def gap_tile(told: dict[str, TrainFigure]) -> Tile:
    """How much room cuts leave."""
    gap = told["gap_per_cut"]
    return Tile(f"{three_figures(gap.value)} m", f"left free by a cut on its track{between(gap, '.3g')}")


def between(figure: TrainFigure, form: str) -> str:
    """The interval in words, '' where there is none."""
    return f" ({figure.low95:{form}} to {figure.high95:{form}})" if math.isfinite(figure.low95) else ""


def one_in(share: float) -> str:
    """So many cuts for one, in at most three figures; rounded down, so that it promises no more than the share."""
    if share <= 0.0:
        return "any number"
    number = 1.0 / share
    digits = 10 ** max(math.floor(math.log10(number)) - 2, 0)
    return f"{math.floor(number / digits) * digits:,}" if number >= 10.0 else f"{math.floor(10.0 * number) / 10.0:g}"


def where_caught(result: HumpedTrial) -> str:
    """The places at which most cuts caught up."""
    routes = result.config.routes
    counts = caught_at(routes, result.found)
    if not counts.any():
        return "No cut caught up."
    places = told_most(counts, [routes.graph.element_called(number) for number in routes.numbers])
    return f"Where cuts caught up, misrouted or in contact ahead of the last position: {places}."


def where_closest(result: HumpedTrial) -> str:
    """Where the closest two cuts of each train met, and of which weight categories they were."""
    routes, found = result.config.routes, result.found
    there = found.tightest_at >= 0
    if not there.any():
        return "What limits the speed: no two cuts shared an element."
    counts = np.bincount(found.tightest_at[there], minlength=len(routes.numbers))
    places = told_most(counts, [routes.graph.element_called(number) for number in routes.numbers])
    names = [member.label for member in result.config.categories.members]
    pairs = np.bincount(
        found.tightest_ahead[there] * len(names) + found.tightest_behind[there], minlength=len(names) ** 2
    )
    kinds = told_most(pairs, [f"{behind} behind {ahead}" for ahead in names for behind in names])
    least = float(np.median(found.tightest_s[there]))
    apart = f"were {least:.1f} s apart" if least >= 0.0 else f"were together for {-least:.1f} s on an element"
    return (
        f"What limits the speed: the closest two cuts of a train {apart} (median of {there.sum()} trains), at "
        f"{places}; they were {kinds}."
    )


def told_most(counts: Ints, names: Sequence[str]) -> str:
    """The most frequent in words, each with its share."""
    order = np.argsort(-counts, kind="stable")[:MOST_PLACES]
    return ", ".join(f"{names[k]} ({100.0 * counts[k] / counts.sum():.0f} %)" for k in order if counts[k] > 0)


def exits_table(result: HumpedTrial) -> Table:
    """The mean exit speed that each position was commanded, by weight category."""
    members = result.config.categories.members
    columns = (
        Column("number", "position"),
        Column("role", "role", words=True),
        *(Column(f"{each.latin}_m_s", each.label, "m/s", decimals(2)) for each in members),
    )
    rows = [exits_row(result, place) for place in range(len(result.config.positions))]
    return Table("exit-speeds", "Exit speeds that were commanded, in the mean", columns, rows)


def exits_row(result: HumpedTrial, place: int) -> Row:
    """Those of one position; a category of which no cut came has none."""
    found, row = result.found, {"number": place + 1, "role": role_words(result.config, place)}
    for k, member in enumerate(result.config.categories.members):
        commands, passes = (shift_sums(found, each[:, place, k]) for each in (found.commands_m_s, found.commanded))
        mean, low, high = ratio(commands, passes)
        row[f"{member.latin}_m_s"] = None if math.isnan(mean) else interval_of(mean, low, high, len(passes))
    return row
