"""What the study `aimed-braking` has found, and its tables."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass

from scripts.studies.aimed_braking.measuring import Measured
from scripts.studies.aimed_braking.published_figures import Beside, Doubled, Line, OverSpeeds
from scripts.studies.aimed_braking.sensitivity import Moved, Sensitivity
from scripts.studies.aiming.trial import Draws, Outcome, Value
from scripts.studies.study import ABSENT, Findings, MarkdownTable, around, plus_minus, table


@dataclass(frozen=True)
class Norm:
    """Metres from the crest to which aiming meets the norm; None: to the last distance tried."""

    name: str
    metres: Value | None


@dataclass(frozen=True)
class AimedBraking(Findings):
    """All parts. `p_overspeed`: the share of over-speeds that commands keep; `last_m`: the last distance tried."""

    draws: Draws
    p_overspeed: float
    last_m: float
    over_speeds: tuple[OverSpeeds, ...]
    by_category: tuple[Line, ...]
    refined: tuple[Line, ...]
    accuracy: tuple[Line, ...]
    by_cars: tuple[Line, ...]
    norms: tuple[Norm, ...]
    sensitivity: tuple[Sensitivity, ...]
    doubled: tuple[Doubled, ...]
    prototype_from_crest: tuple[Beside, ...]
    prototype_behind: tuple[Beside, ...]
    measured_metres: tuple[float, ...]
    measured: tuple[Measured, ...]

    def tables(self) -> Mapping[str, MarkdownTable]:
        """See the titles."""
        gap = f"mean gap a car at a share {self.p_overspeed:g} of over-speeds, m ± half its 95 % interval"
        lines = {
            "category": ("single cars by weight category", self.by_category),
            "refined": ("light single cars by what is known of them", self.refined),
            "accuracy": ("light single cars by the standard deviation of the exit speed", self.accuracy),
            "cars": ("light cuts by their cars", self.by_cars),
        }
        found = {name: line_table(f"{what}: {gap}", rows) for name, (what, rows) in lines.items()}
        found["norm"] = table(
            f"distance from the crest to which the mean gap a car is 3 m at most, share {self.p_overspeed:g}, m",
            ("cuts", "distance"),
            ((each.name, self.metres_cell(each.metres)) for each in self.norms),
        )
        found["sensitivity"] = table(
            "how far the distance of the norm moves, m ± half the 95 % interval of the paired difference; first row: "
            "the distance itself",
            ("input", "assumed", "instead", "light", "heavy", "light, measured"),
            map(self.sensitivity_cells, self.sensitivity),
        )
        found["doubled"] = table(
            "regulators twice as accurate, single cars", DOUBLED_HEADS, map(doubled_cells, self.doubled)
        )
        found["prototype"] = beside_table(f"from the crest: {gap}", self.prototype_from_crest)
        found["prototype-measured"] = beside_table(f"behind the position, light: {gap}", self.prototype_behind)
        found["measuring"] = table(
            f"light single cars by free distance: {gap}; cuts that no command serves, %",
            ("known", *(f"{x:g} m" for x in self.measured_metres), f"not served at {self.measured_metres[-1]:g} m"),
            ((each.name, *map(gap_cell, each.outcomes), unserved_cell(each.outcomes[-1])) for each in self.measured),
        )
        return found

    def metres_cell(self, metres: Value | None) -> str:
        """'414 ± 1', or that it is met everywhere."""
        return f"met to {self.last_m:g}" if metres is None else plus_minus(metres.value, metres.ci95, 1)

    def sensitivity_cells(self, row: Sensitivity) -> tuple[str, ...]:
        """The cells of one input."""
        first = row.name == self.sensitivity[0].name
        return (row.name, row.assumed or ABSENT, row.value or ABSENT,
                *(self.moved_cell(moved, first) for moved in (row.light, row.heavy, row.measured)))  # fmt: skip

    def moved_cell(self, moved: Moved, first: bool) -> str:
        """The distance in the first row, the difference in all others."""
        if first or moved.farther_m is None:
            return self.metres_cell(moved.metres)
        value = moved.farther_m
        half = 0.5 * (value.ci95[1] - value.ci95[0])
        return "0" if value.value == half == 0.0 else f"{value.value:+.1f} ± {half:.1f}"

    def sentences(self) -> tuple[str, ...]:
        """How much was simulated."""
        d = self.draws
        return (
            f"{d.replicates} times {d.design} cuts to choose commands on and {d.report} others to judge them on, seed "
            f"{d.seed}",
        )

    def faults(self) -> tuple[str, ...]:
        """Claims that do not hold."""
        return (*self.falling(), *self.unhelpful())

    def falling(self) -> Iterator[str]:
        """Over-speed must not fall, and the gap not rise, with the commanded speed: so one is monotone in the other."""
        for each in self.over_speeds:
            for before, after in zip(each.rows, each.rows[1:], strict=False):
                if after.overspeed.value < before.overspeed.value or after.gap_m.value > before.gap_m.value:
                    yield f"{each.category}, {each.metres:g} m: over-speed over gap is not monotone"
                    break

    def unhelpful(self) -> Iterator[str]:
        """At 500 m and beyond: the exact exit speed and the exact weight must not gain a tenth; refinement must."""
        base = self.refined[0]
        asked = [(self.accuracy[0], False), *((each, "weight" not in each.name) for each in self.refined[1:])]
        for line, helps in asked:
            for metres, mine, known in zip(line.metres, line.outcomes, base.outcomes, strict=True):
                if metres >= 500.0 and mine and known and (mine.gap_m.value < 0.9 * known.gap_m.value) is not helps:
                    yield f"{line.name}, {metres:g} m: {mine.gap_m.value:.1f} m instead of {known.gap_m.value:.1f} m"


DOUBLED_HEADS = (
    "category", "from the crest, m", "gap before, share 0.115", "gap after, share 0.055", "before / after",
    "the same at share 0.115", "above 2 m/s before, %", "after, %",
)  # fmt: skip


def doubled_cells(row: Doubled) -> tuple[str, ...]:
    """The cells of one distance."""
    return (
        row.category, f"{row.metres:g}", value_cell(row.gap_before_m), value_cell(row.gap_after_m),
        ratio_cell(row.ratio), ratio_cell(row.ratio_at_same_share),
        value_cell(row.above_2_before, 100.0), value_cell(row.above_2_after, 100.0),
    )  # fmt: skip


def ratio_cell(ratio: Value | None) -> str:
    """'1.51 [1.46, 1.56]'."""
    return ABSENT if ratio is None else around(ratio.value, ratio.ci95, 2)


def line_table(title: str, lines: tuple[Line, ...]) -> MarkdownTable:
    """A row a line, a column a distance from the crest."""
    heads = ("cuts", *(f"{x:g} m" for x in lines[0].metres))
    return table(title, heads, ((line.name, *map(gap_cell, line.outcomes)) for line in lines))


def beside_table(title: str, rows: tuple[Beside, ...]) -> MarkdownTable:
    """A row a printed figure."""
    cells = ((r.asked, f"{r.metres:g}", f"{r.prototype_m:g}", gap_cell(r.same_inputs), gap_cell(r.hump)) for r in rows)
    return table(title, ("cuts", "m", "prototype", "same inputs", "our hump"), cells)


def gap_cell(found: Outcome | None) -> str:
    """'12.8 ± 0.4', or that no command keeps the share."""
    return "none" if found is None else value_cell(found.gap_m)


def value_cell(value: Value, scale: float = 1.0) -> str:
    """With digits by its size."""
    digits = 0 if scale * value.value >= 99.5 else 1 if scale * value.value >= 9.95 else 2
    return plus_minus(value.value, value.ci95, digits, scale)


def unserved_cell(found: Outcome | None) -> str:
    """In percent."""
    return ABSENT if found is None else f"{100.0 * found.unserved:.1f}"
