"""A commented configuration to start from: every default written out with its unit, range and origin."""

from __future__ import annotations

import json
from collections.abc import Iterable, Iterator
from itertools import groupby
from typing import Literal, get_origin

from plant_models.library import (
    BUILT_IN,
    WEIGHT_CATEGORIES,
    YARD_CATEGORIES,
    SourcedValue,
    Value,
    car_names,
    position_names,
    sources_cited_in,
)
from plant_models.library.sourced_value import SET_BY_USER
from synth.frame.settings.section import Section, setting_limits, setting_unit
from synth.retarder.configuration.cut_class import CutClass
from synth.retarder.configuration.plant_settings import DEFAULT_POSITION, PositionSettings
from synth.retarder.configuration.resolved_config import ResolvedConfig, resolve
from synth.retarder.configuration.settings import (
    NUMERICAL_SECTIONS,
    OutputSettings,
    RegulatorSettings,
    Settings,
)

HEAD = """\
# Configuration of retarder-synth. Every line shows its default and may be left out.
# A comment says: unit; sensible range (limits, for settings of the tool); origin. Sources stand at the end.
# ASSUMED: no citable source stands behind the number; replace it by that of your retarder."""


def default_config_toml(position_name: str = DEFAULT_POSITION) -> str:
    """The defaults for a position of the library as TOML; it reads back to the same configuration.

    `InputError` if the library has no such position.
    """
    config = resolve(Settings(position=PositionSettings(name=position_name)), "retarder-synth init")
    text = tuple(lines(config))
    return "\n".join((*text, *source_lines(text))) + "\n"


def lines(config: ResolvedConfig) -> Iterator[str]:
    """The lines of the file."""
    yield HEAD
    yield from (f"# Note: {note}" for note in config.retarder.notes)
    yield f"title = {quoted(config.title)}"
    yield '# Your own types (docs/own-types.md) are found in folders: library = ["my-types/"]'
    yield f"# one of the library: {', '.join(BUILT_IN.names(WEIGHT_CATEGORIES))}; or the path of your own file"
    yield f"weight_categories = {quoted(YARD_CATEGORIES)}"
    yield from ("", "[position]", f"# one of the library: {', '.join(position_names())}; or the path of your own file")
    yield f"name = {quoted(config.retarder.name)}"
    switches: dict[str, type[Section]] = {"regulator": RegulatorSettings, "output": OutputSettings}
    for section, values in groupby(config.retarder.provenance, key=lambda value: value.key.rpartition(".")[0]):
        yield from ("", f"[{section}]")
        for value in values:
            yield from (f"# {origin(value)}", f"{value.key.rpartition('.')[2]} = {number_of(value)}")
            if value.key == "track.grade_permille":
                yield "# or pieces, each (start in m, permille): grade_permille = [[0.0, 8.0], [12.0, 5.0]]"
            if value.key == "entry.high_m_s":
                yield "# or, with mean_m_s and std_m_s: normal between the two; or edges_m_s and shares: a histogram"
        if section in switches:
            yield from switch_lines(switches.pop(section))
    for name in NUMERICAL_SECTIONS:
        yield from ("", f"[{name}]")
        section_model = Settings.model_fields[name].default
        for key, field in type(section_model).model_fields.items():
            limits = setting_limits(field)
            span = f"{limits[0]:g} to {limits[1]:g}" if limits else "any"
            yield from (f"# {setting_unit(field)}; {span}; setting: {field.description}", f"{key} = {field.default!r}")
    for name, section_model in switches.items():
        yield from ("", f"[{name}]", *switch_lines(section_model))
    for cut_class in config.cuts:
        yield from cut_lines(cut_class)


def switch_lines(section: type[Section]) -> Iterator[str]:
    """The switches of a section: on or off, or one of a few words."""
    for key, field in section.model_fields.items():
        if field.annotation is bool or get_origin(field.annotation) is Literal:
            yield from (f"# {field.description}", f"{key} = {json.dumps(field.default)}")


def source_lines(text: Iterable[str]) -> Iterator[str]:
    """What is cited in `text`, as comments."""
    yield from ("", "# Sources, by the names in [brackets]:")
    yield from (f"# [{source.name}] {source.reference}" for source in sources_cited_in(text))


def cut_lines(cut_class: CutClass) -> Iterator[str]:
    """The [[cut]] table of a class; what follows from its mass stands as a comment."""
    by_name = {value.key.partition(".")[2]: value for value in cut_class.provenance}
    mean, std = by_name["rolling_resistance.mean_n_per_kn"], by_name["rolling_resistance.std_n_per_kn"]
    (cars,) = cut_class.consist.parts
    yield from ("", "[[cut]]", f"# one of the library: {', '.join(car_names())}; or the path of your own file")
    yield f"car = {quoted(cars.entry.name)}"
    yield from ("# 1; 1 to 60; number of such cars coupled", f"cars = {cars.count}")
    yield from (f"# {origin(by_name['mass_t'])}; of the whole cut", f"mass_t = {cut_class.cut.mass_t!r}")
    yield "# From the mass per axle follow (remove the leading # to change one):"
    yield f"# category = {quoted(cut_class.cut.category)}  # or L, LS, S, ST, T"
    yield f"# entrance_stage = {cut_class.entrance_stage}  # {origin(by_name['entrance_stage'])}"
    allowed = by_name["allowed_stage"]
    mark = "" if allowed.source == SET_BY_USER else "# "
    yield f"{mark}allowed_stage = {cut_class.cut.allowed_stage}  # {origin(allowed)}"
    yield f"# rolling_resistance.mean_n_per_kn = {mean.value!r}  # {origin(mean)}"
    yield f"# rolling_resistance.std_n_per_kn = {std.value!r}  # {origin(std)}"
    yield "# Of the class alone: targets_m_s = [3.0], entry = { low_m_s = 5.0, high_m_s = 6.0 }; of several types of"
    yield '# cars, in place of car and cars: consist = [{ car = "gondola-4", cars = 2 }, { car = "tank-8" }]'


def origin(value: SourcedValue) -> str:
    """Unit; sensible range; source and confidence."""
    confidence = f" (confidence {value.confidence})" if value.confidence else ""
    source = f"ASSUMED, {value.source}" if value.assumed else value.source
    return f"{value.unit}; {value.span or 'any'}; {source}{confidence}"


def number_of(value: SourcedValue) -> str:
    """The value as TOML; the number of a stage is a whole number."""
    return f"{value.value:g}" if value.unit == "stage" else toml_value(value.value)


def toml_value(value: Value) -> str:
    """A number or (nested) list as TOML."""
    return repr(value) if isinstance(value, float) else f"[{', '.join(toml_value(item) for item in value)}]"


def quoted(text: str) -> str:
    """A TOML string."""
    return json.dumps(text, ensure_ascii=False)
