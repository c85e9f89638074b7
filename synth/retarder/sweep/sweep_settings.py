"""The table [sweep] of a configuration file: the grid of cut classes, targets and conditions."""

from __future__ import annotations

import re
from collections.abc import Mapping
from typing import Annotated, Any

from pydantic import AfterValidator, BeforeValidator, Field, model_validator

from plant_models.errors import require
from synth.frame.settings.section import Section, choice, many, optional, setting
from synth.frame.settings.template import template
from synth.retarder.configuration.settings import Settings

MOST_VALUES = 1000
"""Values of one range."""

RANGE_KEYS = {"from", "to", "step"}

NAME = re.compile(r"[A-Za-z0-9](?:[A-Za-z0-9._-]{0,29}[A-Za-z0-9_-])?")

TAKEN = re.compile(
    r"sweep|sheets|plots|configuration\.toml|report\.html|summary\.json|(?:con|prn|aux|nul|com[0-9]|lpt[0-9])(?:\..*)?",
    re.IGNORECASE,
)
"""Names of no condition: what a sweep writes beside their folders, and the devices of Windows and its shares."""


def values(raw: object) -> tuple[float, ...]:
    """A number, a list of numbers, or {from, to, step} as rising or given numbers; `ValueError` for anything else."""
    if is_number(raw):
        return (float(raw),)  # type: ignore[arg-type]  # is_number says so
    if isinstance(raw, list | tuple) and 1 <= len(raw) <= MOST_VALUES and all(is_number(item) for item in raw):
        return tuple(float(item) for item in raw)
    if isinstance(raw, Mapping) and set(raw) == RANGE_KEYS and all(is_number(item) for item in raw.values()):
        return stepped(float(raw["from"]), float(raw["to"]), float(raw["step"]))
    raise ValueError(f"it must be a number, a list of 1 to {MOST_VALUES} numbers, or {{from = …, to = …, step = …}}")


def stepped(low: float, high: float, step: float) -> tuple[float, ...]:
    """`low`, `low` + `step`, … `high`, rounded to 1e-9; both ends are in it."""
    if not (step > 0.0 and low <= high):
        raise ValueError("it must be given with step above 0 and to not below from")
    if not (high - low) / step < 2.0 * MOST_VALUES:
        raise ValueError(f"it must be of at most {MOST_VALUES} values")
    count = round((high - low) / step)
    if abs(low + count * step - high) > 1e-6 * step:
        raise ValueError(f"it must be of a whole number of steps from {low:g} to {high:g}")
    if count >= MOST_VALUES:
        raise ValueError(f"it must be of at most {MOST_VALUES} values, not {count + 1}")
    return tuple(round(low + i * step, 9) for i in range(count + 1))


def is_number(raw: object) -> bool:
    """A finite number of TOML; true and false are none."""
    return isinstance(raw, int | float) and not isinstance(raw, bool) and abs(raw) < float("inf")


def counts(raw: object) -> tuple[int, ...]:
    """As `values`, whole numbers from 1 to 60."""
    found = values(raw)
    if not all(value == int(value) and 1 <= value <= 60 for value in found):
        raise ValueError("it must be made of whole numbers from 1 to 60")
    return tuple(int(value) for value in found)


def condition_name(name: str) -> str:
    """Validator: `name` itself, which can be that of a folder of a condition."""
    if not NAME.fullmatch(name):
        raise ValueError(
            "it must be made of at most 31 letters, digits, dots, hyphens and underscores, with no dot at the end"
        )
    if TAKEN.fullmatch(name):
        raise ValueError("it must be another name: a file or folder of the sweep, or a device of Windows, has this one")
    return name


def unit(of: str) -> dict[str, Any]:
    """What is noted of values that the plant bounds, and no declaration."""
    return {"unit": of, "source": ""}


Several = float | list[float] | dict[str, float]
"""As a file may write values."""

Values = Annotated[tuple[float, ...], BeforeValidator(values, json_schema_input_type=Several)]
Counts = Annotated[tuple[int, ...], BeforeValidator(counts, json_schema_input_type=Several)]
Name = Annotated[str, AfterValidator(condition_name)]
Changes = dict[str, Any] | None


class SweptCuts(Section):
    """Cut classes of one type of cars: every number of cars with every mass of a car."""

    car: str = Field(description="type of the cars, as in [[cut]]")
    cars: Counts = choice((1,), "number of cars, 1 to 60, a list, or a range")
    mass_per_car_t: Values = Field(
        description="mass of a car with its load, a list, or a range: { from = 22, to = 84, step = 2 }",
        json_schema_extra=unit("t"),
    )

    def cuts(self) -> list[dict[str, Any]]:
        """The same as [[cut]] tables, masses innermost."""
        return [
            {"car": self.car, "cars": cars, "mass_t": round(cars * mass, 9)}
            for cars in self.cars
            for mass in self.mass_per_car_t
        ]


class SweptCondition(Section):
    """A condition: what the weather and the wear of the position change. It has a book of its own, in its folder."""

    name: Name = Field(description="of its folder")
    position: Changes = choice(None, "keys of [position] that are other than in the file")
    retarder: Changes = choice(None, "the same of [retarder]")
    track: Changes = choice(None, "of [track]")
    entry: Changes = choice(None, "of [entry]")
    friction: Changes = choice(None, "of [friction]")
    sensor: Changes = choice(None, "of [sensor]")

    def changes(self) -> dict[str, Any]:
        """What is other, as the file has it."""
        return self.model_dump(exclude={"name"}, exclude_none=True)


class SweepSettings(Section):
    """What is swept; all that is left out is as the rest of the file has it.

    Every section that 'retarder-synth init' prints may stand beside this table.
    """

    exit_speeds_m_s: Values | None = Field(
        None,
        description="targets of all classes, a list or a range; otherwise those of [targets]",
        examples=[{"from": 1.5, "to": 5.0, "step": 0.5}],
        json_schema_extra=unit("m/s"),
    )
    passes: int = setting(2000, "1", 1000, 50_000, "stratified passes that each table is simulated on")
    interpolation_loss_m_s: float | None = optional(
        "m/s", 1e-5, 1.0, "refine the targets until lines between two tables lose no more rms than this", 0.001
    )
    smallest_step_m_s: float = setting(0.125, "m/s", 0.01, 5.0, "no step between two targets is refined below this")
    tables: bool = choice(False, "write every table as JSON too, besides the book")
    cut: tuple[SweptCuts, ...] = many(
        (),
        0,
        MOST_VALUES,
        "tables [[sweep.cut]]",
        example=(SweptCuts(car="gondola-4", mass_per_car_t=(22.0, 52.0, 85.0)),),
    )
    condition: tuple[SweptCondition, ...] = many(
        (),
        0,
        MOST_VALUES,
        "tables [[sweep.condition]]",
        example=(SweptCondition(name="dry"), SweptCondition(name="wet", friction={"common_cv": 0.2})),
    )

    @model_validator(mode="after")
    def _apart(self) -> SweepSettings:
        names = [each.name.lower() for each in self.condition]
        for place, name in enumerate(names):
            require(
                name not in names[:place],
                f"condition holds {self.condition[place].name!r} twice, where case does not count; give each condition "
                "a name of its own",
            )
        return self


class SweepTable(Section):
    """Of the file of a sweep, what a configuration has not."""

    sweep: SweepSettings = SweepSettings()


class SweepFileSettings(Settings, SweepTable):
    """The whole file of a sweep."""


def default_sweep_toml() -> str:
    """The defaults as TOML; it reads back to the same sweep."""
    return template(SweepTable(), "Sweep over classes, targets and conditions", "sweep run")
