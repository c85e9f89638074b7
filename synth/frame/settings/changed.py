"""Settings with other values, checked as those of a file are."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, TypeVar

from pydantic import ValidationError

from plant_models.errors import PlantError, require
from synth.frame.settings.file_fault import faults_in
from synth.frame.settings.section import Section

S = TypeVar("S", bound=Section)


def changed(section: S, **values: Any) -> S:
    """`section` with other `values`; `PlantError` for one that its declaration does not allow."""
    held = {key: getattr(section, key) for key in type(section).model_fields}
    return made(type(section), **{**held, **values})


def made(model: type[S], **values: Any) -> S:
    """A section with these `values`; `PlantError` for one that its declaration does not allow."""
    try:
        return model.model_validate(values)
    except ValidationError as error:
        raise PlantError("; ".join(faults_in(error, model))) from None


def with_inputs(section: S, inputs: Mapping[str, float]) -> S:
    """`section` with other numbers: `{"prices.per_car_h": 2.0}` goes into its tables by their names.

    A number that is whole takes the nearest one. `PlantError` for a name that is none of its numbers, and for a number
    that is not allowed.
    """
    tables: dict[str, dict[str, float]] = {}
    given: dict[str, Any] = {}
    for name, number in inputs.items():
        head, _, rest = name.partition(".")
        held = getattr(section, head, None) if head in type(section).model_fields else None
        require(
            (isinstance(held, Section) and bool(rest)) or (isinstance(held, int | float) and not rest),
            f"{name!r} is no input of {type(section).__name__}; it has {', '.join(type(section).model_fields)}",
        )
        if rest:
            tables.setdefault(head, {})[rest] = number
        else:
            given[head] = round(number) if isinstance(held, int) else number
    for head, inner in tables.items():
        given[head] = with_inputs(getattr(section, head), inner)
    return changed(section, **given)
