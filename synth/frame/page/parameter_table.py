"""Every parameter with its origin; assumed ones are marked in words and colour."""

from __future__ import annotations

from collections.abc import Sequence

from plant_models.library import SourcedValue, Value, sources_cited_in
from synth.frame.page.markup import Cell, Markup, element, fold, head_row, joined, table
from synth.frame.printed_numbers import ABSENT, counted

COLUMNS = ("key", "value", "unit", "sensible range", "origin", "confidence", "")


def parameter_section(parameters: Sequence[SourcedValue]) -> Markup:
    """A sentence on the assumed ones, and the table."""
    assumed = sum(parameter.assumed for parameter in parameters)
    lead = (
        f"{counted(len(parameters), 'parameter')}, {assumed} of them assumed: no citable source stands behind them. "
        "Replace those by the data of your retarder before you rely on a number of this page."
    )
    rows = [(parameter_row(parameter), "assumed" if parameter.assumed else "") for parameter in parameters]
    shown = table("Parameters", (head_row(*COLUMNS),), rows, kind="parameters")
    return joined((element("p", lead), fold("All parameters, and their sources", shown, source_list(parameters))))


def source_list(parameters: Sequence[SourcedValue]) -> Markup:
    """What the parameters cite, with author, title, year and where to find it."""
    cited = sources_cited_in(parameter.source for parameter in parameters)
    if not cited:
        return Markup()
    entries = (element("li", element("code", f"[{source.name}]"), f" {source.reference}") for source in cited)
    return joined((element("h3", "Sources"), element("ul", *entries)))


def parameter_row(parameter: SourcedValue) -> list[str | Cell]:
    """The cells of one parameter."""
    low_high = parameter.span or ABSENT
    outside = "" if parameter.in_range else "bad"
    return [
        Cell(parameter.key, kind="code"),
        Cell(value_text(parameter.value), kind=outside),
        parameter.unit,
        Cell(low_high if parameter.in_range else f"{low_high}: exceeded", kind=outside),
        parameter.source,
        parameter.confidence or ABSENT,
        Cell("assumed" if parameter.assumed else "", kind="mark"),
    ]


def value_text(value: Value) -> str:
    """A number as short as it reads back, lists with commas, pairs in brackets."""
    if isinstance(value, tuple):
        return ", ".join(f"({value_text(item)})" if isinstance(item, tuple) else value_text(item) for item in value)
    return f"{value:.9g}"
