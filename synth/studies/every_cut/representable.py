"""Those of the tuned classical rules that a table can express: lines over the path, and one stage a command."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

from synth.book.comparison.baselines import FAMILIES, Family
from synth.simulation.closed_loop import LineController


def one_stage_a_command(family: Family) -> Family:
    """The same law, which may not jump over stages."""

    def build(*arguments: Any) -> LineController:
        return replace(family.build(*arguments), multi_step=False)

    return replace(family, build=build)


def without(family: Family, name: str) -> Family:
    """The same law with its parameter `name` held at 0."""
    at = family.names.index(name)

    def build(*arguments: Any) -> LineController:
        others, values = arguments[: -len(family.names) + 1], arguments[-len(family.names) + 1 :]
        return family.build(*others, *values[:at], 0.0, *values[at:])

    def left(every: tuple[Any, ...]) -> tuple[Any, ...]:
        return every[:at] + every[at + 1 :]

    return replace(family, build=build, names=left(family.names), grids=left(family.grids), bounds=left(family.bounds))


def representable() -> tuple[Family, ...]:
    """Single threshold, two-threshold relay, and the energy rule without lead; each is tuned as such."""
    by_name = {family.name: family for family in FAMILIES}
    laws = (by_name["single threshold"], by_name["two-threshold relay"], without(by_name["energy rule"], "lead_s"))
    return tuple(one_stage_a_command(law) for law in laws)
