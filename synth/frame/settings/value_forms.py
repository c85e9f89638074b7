"""Forms of values that a configuration file may hold beside numbers, names and switches."""

from __future__ import annotations

from typing import Annotated

from pydantic import AfterValidator, Field, PlainValidator, WithJsonSchema

from plant_models.library import Value
from plant_models.library.data_file import Form, form_name, number_or_pairs, numbers, pairs
from plant_models.library.form_schema import FORMS


def in_form(form: Form) -> PlainValidator:
    """Validator by a form of the library."""

    def check(raw: object) -> Value:
        value = form(raw)
        if value is None:
            raise ValueError(f"it must be {form_name(form)}")
        return value

    return PlainValidator(check)


def printable(text: str) -> str:
    """Validator: `text` itself; `ValueError` where it holds what no terminal and no page should get."""
    if not text.isprintable():
        raise ValueError("it must be made of printable characters")
    return text


Numbers = Annotated[tuple[float, ...], in_form(numbers), WithJsonSchema(FORMS[numbers])]
Pairs = Annotated[tuple[tuple[float, float], ...], in_form(pairs), WithJsonSchema(FORMS[pairs])]
Grade = Annotated[
    float | tuple[tuple[float, float], ...], in_form(number_or_pairs), WithJsonSchema(FORMS[number_or_pairs])
]
Title = Annotated[str, AfterValidator(printable)]

Source = Annotated[str, Field(min_length=1, max_length=400), AfterValidator(printable)]
"""Where a number is from, in the user's words."""
