"""What can drift at a retarder position, by how much the watch supposes it to, and what is done about it."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, replace
from enum import Enum

from synth.logs import unknowns as asked
from synth.logs.fitting_passes import FittingPasses

Values = Mapping[str, float]


class Remedy(Enum):
    """What is done about a drift."""

    RETUNE = "retune"
    REPAIR = "repair"


@dataclass(frozen=True)
class Scale:
    """How a size acts on a number: `moved` (value, size), `neutral` size that moves nothing, `unit` of sizes."""

    moved: Callable[[float, float], float]
    neutral: float
    unit: str


TIMES = Scale(lambda value, size: value * size, 1.0, "times")


def plus(unit: str) -> Scale:
    """Sizes that are added."""
    return Scale(lambda value, size: value + size, 0.0, unit)


@dataclass(frozen=True)
class Cause:
    """One number that can drift, or several that do so together.

    `sizes`: of supposed drifts, rising, with the neutral one; `watched`: the two of them that charts are kept of;
    `keys`: the numbers that a size acts on; none for an offset of the gauge, which is no number of the likelihood.
    `category`: only passes of this weight category tell of it, '' for all. `advice`: what a person does.
    """

    name: str
    title: str
    keys: tuple[str, ...]
    scale: Scale
    sizes: tuple[float, ...]
    watched: tuple[float, float]
    remedy: Remedy
    advice: str
    category: str = ""

    @property
    def as_watched(self) -> Cause:
        """The same with those sizes alone that charts are kept of: an eighth of the work."""
        return replace(self, sizes=(self.watched[0], self.scale.neutral, self.watched[1]))

    def moved(self, values: Values, size: float) -> dict[str, float]:
        """`values` after a drift by `size`."""
        return dict(values) | {key: self.scale.moved(values[key], size) for key in self.keys}

    def told(self, size: float) -> str:
        """A size in words: '-30 %' or '+0.10 m/s'."""
        if self.scale.unit == TIMES.unit:
            return f"{100.0 * (size - 1.0):+.0f} %"
        digits = 3 if self.scale.unit == "m/s" else 1
        return f"{size:+.{digits}f} {self.scale.unit}"


def geometric(step: float, reach: int, watched: int = 1) -> tuple[tuple[float, ...], tuple[float, float]]:
    """Sizes step^−reach … step^reach, and those `watched` steps from 1."""
    return tuple(step**k for k in range(-reach, reach + 1)), (step**-watched, step**watched)


def even(step: float, reach: int, watched: int) -> tuple[tuple[float, ...], tuple[float, float]]:
    """Sizes −reach · step … reach · step, and those `watched` steps from 0."""
    return tuple(step * k for k in range(-reach, reach + 1)), (-watched * step, watched * step)


NEW_TABLES = "make new tables from the numbers of now ('retune')"
PADS = "look at pads, wear and linkage; friction of one weight category alone points at the wheels or at the weighing"


def causes_of(passes: FittingPasses, values: Values, slope_key: str) -> tuple[Cause, ...]:
    """All that `passes` can tell of; `values` is the baseline."""
    return tuple(
        cause
        for cause in (*_of_friction(passes, slope_key), *_of_drive(), *_of_sensors(passes, values))
        if all(values.get(key, 0.0) > 0.0 or cause.scale.unit != TIMES.unit for key in cause.keys)
    )


def _of_friction(passes: FittingPasses, slope_key: str) -> Iterator[Cause]:
    sizes = geometric(1.15, 5)
    yield Cause("friction", "mean friction", (slope_key,), TIMES, *sizes, Remedy.RETUNE, NEW_TABLES)
    categories = sorted({passes.log.category[number] for number in range(len(passes))})
    for category in categories if len(categories) > 1 else ():
        yield Cause(
            f"friction of {category}", f"friction of category {category}", (slope_key,), TIMES, *sizes, Remedy.RETUNE,
            f"{PADS}; else {NEW_TABLES}", category,
        )  # fmt: skip
    yield Cause(
        "friction spread", "spread of friction from cut to cut", (asked.COMMON_CV,), TIMES, *geometric(1.4, 3),
        Remedy.RETUNE, NEW_TABLES,
    )  # fmt: skip
    classes = sorted(set(passes.class_of.tolist()))
    keys = tuple(dict.fromkeys(asked.RESISTANCE + passes.plants[number][1].cut.category for number in classes))
    yield Cause("rolling resistance", "rolling resistance", keys, TIMES, *geometric(1.25, 4), Remedy.RETUNE, NEW_TABLES)


def _of_drive() -> Iterator[Cause]:
    drive = (
        ("fill constant", asked.FILL, 1.12, "look at supply valve, supply pressure and leaks of the brake cylinder"),
        ("exhaust constant", asked.EXHAUST, 1.12, "look at the exhaust valve, its silencer and the pipes: they let out "
         "too slowly or too fast"),
        ("brake delay", asked.BRAKE_DELAY, 1.2, "look at the supply valve and its magnet: it opens at another time"),
        ("release delay", asked.RELEASE_DELAY, 1.2, "look at the exhaust valve and its magnet: it opens at another "
         "time"),
        ("dead band", asked.DEAD_BAND, 1.12, "look at the pressure switches of the stages"),
        ("touch pressure", asked.TOUCH_PRESSURE, 1.1, "look at pads (worn, changed), their gap to the wheel, and the "
         "linkage"),
    )  # fmt: skip
    for name, key, step, advice in drive:
        yield Cause(name, name, (key,), TIMES, *geometric(step, 8, 2), Remedy.REPAIR, advice)


def _of_sensors(passes: FittingPasses, values: Values) -> Iterator[Cause]:
    if asked.BIAS in values and passes.log.path_is_independent:
        advice = "adjust the speed sensor (angle, mounting); until then the tables aim wrong by as much"
        yield Cause("sensor bias", "bias of the speed sensor", (asked.BIAS,), plus("m/s"), *even(0.025, 10, 2),
                    Remedy.REPAIR, advice)  # fmt: skip
    yield Cause(
        "sensor noise", "noise of the speed sensor", (asked.NOISE,), TIMES, *geometric(1.2, 6, 2), Remedy.REPAIR,
        "look at the speed sensor: lens, mounting, disturbance",
    )  # fmt: skip
    if asked.GAUGE_NOISE in values and passes.log.has_gauge:
        advice = "adjust the pressure gauge; retarder and tables are not concerned"
        yield Cause("gauge offset", "offset of the pressure gauge", (), plus("kPa"), *even(2.0, 10, 2), Remedy.REPAIR,
                    advice)  # fmt: skip
