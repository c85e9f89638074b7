"""The table [sweep] of a configuration file: the grid of cut classes, targets and conditions."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated, Any

from pydantic import Field, PlainValidator

from synth.frame.settings.section import Section, many

MOST_VALUES = 1000
"""Values of one range."""

RANGE_KEYS = {"from", "to", "step"}

CONDITION_SECTIONS = ("position", "retarder", "track", "entry", "friction", "sensor")
"""Sections of the file that a condition may change: what the weather and the wear of a position change."""

SMALLEST_STEP_M_S = 0.125


def values(raw: object) -> tuple[float, ...]:
    """A number, a list of numbers, or {from, to, step} as rising or given numbers; `ValueError` for anything else."""
    if is_number(raw):
        return (float(raw),)  # type: ignore[arg-type]  # is_number says so
    if isinstance(raw, list) and 1 <= len(raw) <= MOST_VALUES and all(is_number(item) for item in raw):
        return tuple(float(item) for item in raw)
    if isinstance(raw, Mapping) and set(raw) == RANGE_KEYS and all(is_number(item) for item in raw.values()):
        return stepped(float(raw["from"]), float(raw["to"]), float(raw["step"]))
    raise ValueError(f"it must be a number, a list of 1 to {MOST_VALUES} numbers, or {{from = …, to = …, step = …}}")


def stepped(low: float, high: float, step: float) -> tuple[float, ...]:
    """`low`, `low` + `step`, … `high`, rounded to 1e-9; both ends are in it."""
    if not (step > 0.0 and low <= high):
        raise ValueError("it must have step above 0 and to not below from")
    if not (high - low) / step < 2.0 * MOST_VALUES:
        raise ValueError(f"it must have at most {MOST_VALUES} values")
    count = round((high - low) / step)
    if abs(low + count * step - high) > 1e-6 * step:
        raise ValueError(f"it must have a whole number of steps from {low:g} to {high:g}")
    if count >= MOST_VALUES:
        raise ValueError(f"it must have at most {MOST_VALUES} values, not {count + 1}")
    return tuple(round(low + i * step, 9) for i in range(count + 1))


def is_number(raw: object) -> bool:
    """A finite number of TOML; true and false are none."""
    return isinstance(raw, int | float) and not isinstance(raw, bool) and abs(raw) < float("inf")


def counts(raw: object) -> tuple[int, ...]:
    """As `values`, whole numbers from 1 to 60."""
    found = values(raw)
    if not all(value == int(value) and 1 <= value <= 60 for value in found):
        raise ValueError("it must hold whole numbers from 1 to 60")
    return tuple(int(value) for value in found)


Values = Annotated[tuple[float, ...], PlainValidator(values)]
Counts = Annotated[tuple[int, ...], PlainValidator(counts)]


class SweptCuts(Section):
    """Cut classes of one car type: every number of cars with every mass of a car."""

    car: str
    cars: Counts = (1,)
    mass_per_car_t: Values

    def cuts(self) -> list[dict[str, Any]]:
        """The same as [[cut]] tables, masses innermost."""
        return [
            {"car": self.car, "cars": cars, "mass_t": round(cars * mass, 9)}
            for cars in self.cars
            for mass in self.mass_per_car_t
        ]


class SweepSettings(Section):
    """What is swept; all that is left out is as the rest of the file has it.

    `condition`: tables with a name and the sections of the file that differ. With `interpolation_loss_m_s` the targets
    are the coarse ones, refined until lines between two tables lose no more than that.
    """

    exit_speeds_m_s: Values | None = None
    cut: tuple[SweptCuts, ...] = many((), 0, MOST_VALUES, "tables [[sweep.cut]]")
    condition: tuple[dict[str, Any], ...] = many((), 0, MOST_VALUES, "tables [[sweep.condition]]")
    passes: int = Field(2000, ge=1000, le=50_000)
    interpolation_loss_m_s: float | None = Field(None, ge=1e-5, le=1.0)
    smallest_step_m_s: float = Field(SMALLEST_STEP_M_S, ge=0.01, le=5.0)
    tables: bool = False
