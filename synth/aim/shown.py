"""What is shown of aim tables: what is asked, gaps and over-speeds, pictures, every cell, the files of controllers."""

from __future__ import annotations

import math
from collections.abc import Iterator
from functools import partial
from typing import Any, Final

from plant_models.library.weight_category import WeightCategory
from synth.aim.aim_book import AimBook, AimBookVerdict, AimVerdict, MadeAim, order_of
from synth.aim.aim_curves import aim_curves, runners
from synth.aim.resolved_aim import ResolvedAim
from synth.aim.table_position import position_of
from synth.frame.exhibits import Chart, Column, Exhibit, File, Row, Sentence, Table, Tile, Tiles
from synth.frame.interval import Interval
from synth.frame.printed_numbers import decimals, percent
from synth.retarder.forms.code_options import PLAIN
from synth.retarder.forms.table_forms import FORMS
from synth.retarder.tuned_case import file_stem

SHOWN: Final = 4
"""Free distances of a brief row."""

HOW_TO_READ: Final = (
    "Free distance: what the head of a cut has still to roll to the standing cars when its last axle leaves the "
    "position. Over-speed: the cut couples faster than allowed. Gap: what stays free where a cut stops before. All "
    "figures are of cuts that the speeds were not chosen on; brackets: 95 % intervals, of a share exact (Clopper and "
    "Pearson), of a mean normal; they cover the chance of these cuts only. A cut for whose reading no exit speed keeps "
    "what is asked is let go at the lowest speed and counts in its row; the last column tells how many these are."
)
WITHOUT: Final = (
    "No exit speed keeps that chance in some cells: where the track falls more than the cut resists, even one that is "
    "let go at the lowest speed arrives too fast. These cells are null in the tables, and a controller gets no answer "
    "there."
)


def in_per_cent(share: float) -> str:
    """A probability."""
    return f"{percent(share)} %"


TABLES = (
    Column("id", "table", words=True),
    Column("category", "category", words=True),
    Column("knowledge", "known", words=True),
    Column("chosen_on_cuts", "chosen on cuts"),
    Column("judged_on_cuts", "judged on others"),
    Column("worst", "worst cell, over-speed", form=in_per_cent),
    Column("cells", "cells"),
    Column("cells_with_figures", "with figures"),
    Column("cells_missed", "missed"),
    Column("cells_without_speed", "without a speed"),
    Column("above_m_s", "interpolated above", "m/s", decimals(3)),
    Column("below_m_s", "interpolated below", "m/s", decimals(3)),
)
CELLS = (
    Column("id", "table", words=True, once=True),
    Column("cars", "cars"),
    Column("free_distance_m", "free distance", "m"),
    Column("lowest_m_s", "exit speed from", "m/s", decimals(3)),
    Column("highest_m_s", "to", "m/s", decimals(3)),
    Column("gap_m", "mean gap of a cut", "m", decimals(2)),
    Column("overspeed", "over-speed", form=in_per_cent),
    Column("without", "without an exit speed", form=in_per_cent),
)


def asked(book: AimBook, verdict: AimBookVerdict) -> Iterator[Exhibit]:
    """What is required of the tables, how exactly the position obeys, and what cannot be served."""
    config = book.config
    yield tiles(verdict)
    yield Sentence(
        f"Asked: at most {100.0 * config.aim.p_overspeed:g} of 100 cuts couple faster than "
        f"{config.scene.coupling_speed_m_s:g} m/s. The position {config.position_name} lets a cut go "
        f"{config.scene.exit_m:g} m from the crest; {exactness(book)}.",
        {"p_overspeed": config.aim.p_overspeed, "coupling_speed_m_s": config.scene.coupling_speed_m_s},
    )
    yield from (Sentence(note) for note in config.notes)
    without = [each for each in verdict.tables if each.without]
    if without:
        named = "; ".join(f"{each.table}: {each.without} of {each.cells} cells" for each in without)
        yield Sentence(f"{WITHOUT} {named}.")


def tiles(verdict: AimBookVerdict) -> Tiles:
    """How many tables keep the chance, the worst cell, and where there is no exit speed."""
    judged = verdict.tables
    kept, cells = sum(not each.missed for each in judged), sum(each.cells for each in judged)
    worst = max((each.worst for each in judged if each.worst is not None), key=lambda each: each.low95, default=None)
    without = sum(each.without for each in judged)
    made = [Tile(f"{kept} of {len(judged)}", "tables keep the chance that is asked for", verdict.accepted)]
    if worst is not None:
        low, high = in_per_cent(worst.low95), in_per_cent(worst.high95)
        where = f"in the worst of {sum(each.told for each in judged)} cells [{low}, {high}]"
        made.append(Tile(in_per_cent(worst.value), f"of the cuts couple too fast {where}"))
    if without:
        made.append(Tile(f"{without} of {cells}", "cells have no exit speed: a controller gets no answer there"))
    return Tiles(made)


def exactness(book: AimBook) -> str:
    """How exactly the position obeys."""
    config = book.config
    if config.book is not None:
        return f"its exit speeds are those of closed loops of the controller tables in {config.book[0].name}"
    return f"its exit speeds have a normal error of {config.exit_std_m_s:g} m/s"


def gaps(book: AimBook, verdict: AimBookVerdict) -> Iterator[Exhibit]:
    """Mean gaps of the shortest and the longest cuts at some distances, and each table with its worst cell."""
    distances = book.config.aim.free_distances_m
    some = sorted({round(k * (len(distances) - 1) / (SHOWN - 1)) for k in range(SHOWN)})
    columns = (
        Column("cuts", "cuts", words=True, once=True),
        Column("cars", "cars"),
        *(
            Column(f"at_{distances[place]:g}_m", f"gap at {distances[place]:g} m", "m", decimals(2), spare=2)
            for place in some
        ),
        Column("worst", "worst cell, over-speed", form=in_per_cent, once=True),
    )
    rows = [
        row
        for made, judged in zip(book.tables, verdict.tables, strict=True)
        for row in gap_rows(book, made, judged, some)
    ]
    yield Table("gaps", "Mean gap of a cut by free distance", columns, rows, brief=True)
    told = [table_row(made, judged) for made, judged in zip(book.tables, verdict.tables, strict=True)]
    yield Table("aim-tables", "Tables", TABLES, told, bad=is_missed)
    above = max(made.speeds.above_m_s for made in book.tables)
    below = max(made.speeds.below_m_s for made in book.tables)
    yield Sentence(
        f"Between two nodes a controller takes a straight line. Midway it was found to be at most {above:.3f} m/s "
        f"above and {below:.3f} m/s below what is right there."
    )


def gap_rows(book: AimBook, made: MadeAim, judged: AimVerdict, some: list[int]) -> Iterator[Row]:
    """The shortest and the longest cuts of a table."""
    for i in sorted({0, len(book.config.cars) - 1}):
        row: dict[str, Any] = {
            "cuts": f"{made.category.name} by {made.knowledge}",
            "cars": book.config.cars[i],
            "worst": judged.worst,
        }
        for place in some:
            row[f"at_{book.config.aim.free_distances_m[place]:g}_m"] = gap_of(made, i, place)
        yield row


def table_row(made: MadeAim, judged: AimVerdict) -> Row:
    """Everything about one table but its cells."""
    return {
        "id": made.table.id,
        "category": made.category.name,
        "knowledge": made.known,
        "chosen_on_cuts": made.speeds.order.design_cuts,
        "judged_on_cuts": made.speeds.order.report_cuts,
        "worst": judged.worst,
        "cells": judged.cells,
        "cells_with_figures": judged.told,
        "cells_missed": len(judged.missed),
        "cells_without_speed": judged.without,
        "above_m_s": made.speeds.above_m_s,
        "below_m_s": made.speeds.below_m_s,
    }


def is_missed(row: Row) -> bool:
    """A cell of the table misses the limit."""
    return bool(row["cells_missed"])


def gap_of(made: MadeAim, i: int, j: int) -> Interval | None:
    """The mean gap of cuts of one length at one distance."""
    found = made.speeds.of_all
    value, low, high = (float(each[i, j]) for each in (found.gap_m, found.gap_low95_m, found.gap_high95_m))
    return None if math.isnan(value) else Interval(value, low, high, made.speeds.order.report_cuts)


def overspeed_of(made: MadeAim, i: int, j: int) -> Interval | None:
    """Their share that couples too fast."""
    found = made.speeds.of_all
    ends = (found.overspeed, found.overspeed_low95, found.overspeed_high95)
    value, low, high = (float(each[i, j]) for each in ends)
    return None if math.isnan(value) else Interval(value, low, high, made.speeds.order.report_cuts)


def cells(book: AimBook) -> Iterator[Exhibit]:
    """A row for each number of cars and distance of every table; those without any exit speed are marked."""
    rows = [row for made in book.tables for row in cell_rows(made)]
    yield Table("cells", "Every number of cars and free distance", CELLS, rows, bad=is_without)
    yield Sentence(HOW_TO_READ)


def cell_rows(made: MadeAim) -> Iterator[Row]:
    """The rows of one table; exit speeds from the lowest to the highest over the readings."""
    order = made.speeds.order
    for i, cars in enumerate(order.cars):
        for j, distance in enumerate(order.free_distances_m):
            known = [float(speed) for speed in made.speeds.speed_m_s[i, j].flat if math.isfinite(speed)]
            yield {
                "id": made.table.id,
                "cars": cars,
                "free_distance_m": distance,
                "lowest_m_s": min(known, default=None),
                "highest_m_s": max(known, default=None),
                "gap_m": gap_of(made, i, j),
                "overspeed": overspeed_of(made, i, j),
                "without": float(made.speeds.of_all.without[i, j]),
            }


def is_without(row: Row) -> bool:
    """No exit speed keeps what is asked."""
    return bool(row["without"] == 1.0)


def files(book: AimBook) -> Iterator[Exhibit]:
    """What controllers load: the tables in every form."""
    tables = [made.table for made in book.tables]
    for folder, form in (("tables", "json"), ("tables", "csv"), ("c", "c"), ("st", "st")):
        yield from (File(f"{folder}/{name}", content) for name, content in FORMS[form](tables, PLAIN).items())


def charts(book: AimBook) -> Iterator[Exhibit]:
    """Gaps, chances by category, and the track."""
    config = book.config
    yield Chart(
        "aim-gaps",
        "Mean gap over free distance",
        "Mean gap that a cut leaves before the standing cars where the tables are used, on cuts that their speeds were "
        "not chosen on. Cuts for which no exit speed keeps the chance are let go at the lowest speed.",
        lambda: _pictures().gaps(book),
    )
    yield from (chances_of(config, member) for member in config.members)
    ends = dict.fromkeys((config.members[0], config.members[-1]))
    rolled = partial(runners, config.scene, seed=config.simulation.seed)
    yield Chart(
        "aim-track",
        "Track and runners",
        "Height of the track, and energy heads v²/(2g') of single cars that leave the bunch position and are not "
        "braked behind it. Where a line meets the track, the car stops.",
        lambda: _pictures().track(config.scene, [rolled(category=member) for member in ends]),
    )


def chances_of(config: ResolvedAim, member: WeightCategory) -> Chart:
    """What one exit speed gives to all cuts of a category."""
    order = order_of(config, member, position_of(config))
    return Chart(
        file_stem("aim-chances", member.latin),
        f"Chance of over-speed and gap, category {member.name}",
        f"Category {member.name}: share of cuts that couple too fast and mean gap where all cuts are commanded one "
        "exit speed, and one against the other. Below its curve leads only what tells more of a single cut.",
        lambda: _pictures().chances(aim_curves(config.scene, order, config.cars[0])),
    )


def _pictures() -> Any:
    from synth.aim import pictures  # matplotlib

    return pictures
