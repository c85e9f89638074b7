"""The keys of a configuration for its page: what a declaration says of each, in a table.

Between <!-- keys NAME --> and <!-- end --> stands that of the configuration NAME, and where its sources are.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Final

from pydantic.fields import FieldInfo

from plant_models.library import load_wheel_sensor
from plant_models.library.source import CITATION
from scripts.studies.markdown_table import table
from synth.aim.configuration.settings import AimFileSettings
from synth.aim.configuration.template import usual_aim
from synth.computer.settings import ComputerSettings
from synth.frame.settings.section import Section, sections_in
from synth.frame.settings.template import NOTHING
from synth.frame.settings.told import Told, Usual, told_key, told_numbers, words_of
from synth.frame.settings.toml_text import value_text
from synth.hump.configuration.settings import HumpTrialSettings
from synth.hump.configuration.template import usual_trial
from synth.hump.making.short_file import NEEDED
from synth.hump.making.short_hump import EXAMPLE
from synth.hump.watching.settings import EXAMPLE as YARD
from synth.retarder.configuration.config_template import known_of
from synth.retarder.configuration.point_sensors.settings import DEFAULT_WHEEL_SENSOR, PointSensorSettings
from synth.retarder.configuration.resolved_config import resolve
from synth.retarder.configuration.settings import Settings
from synth.retarder.sweep.sweep_settings import SweepTable

DECLARED: Final[dict[str, Callable[[], tuple[Section, Usual]]]] = {
    "aim": lambda: (AimFileSettings(), usual_aim()),
    "computer": lambda: (ComputerSettings(), NOTHING),
    "hump": lambda: (HumpTrialSettings(), usual_trial()),
    "short-hump": lambda: (EXAMPLE.model_copy(update=dict.fromkeys((*NEEDED, "tracks", "position"))), NOTHING),
    "sweep": lambda: (SweepTable(), NOTHING),
    "yard": lambda: (YARD.model_copy(update={"position": None}), NOTHING),
    "tune": lambda: (Settings(), known_of(resolve(Settings(), "the default configuration"))),
    "sensors": lambda: (
        PointSensorSettings.model_construct(path_m=()),
        told_numbers(load_wheel_sensor(DEFAULT_WHEEL_SENSOR).provenance),
    ),
}
"""Configurations, or a section of one, and what the library has for keys that are left out."""

HEAD = ("key", "unless given", "unit", "allowed", "is", "from")


def keys_of(name: str, sources: str) -> str:
    """The keys of the configuration `name` as Markdown; `sources`: the page of the sources, as it is linked."""
    text = table(f"keys {name}", HEAD, rows_of(*DECLARED[name](), "")).markdown()
    links = "".join(f"[{cited}]: {sources}#{cited}\n" for cited in sorted(set(CITATION.findall(text))))
    return f"{text}\n{links}" if links else text


def rows_of(section: Section, usual: Usual, path: str) -> Iterator[tuple[str, ...]]:
    """A row for each table of the file, then one for each of its keys."""
    inner: list[tuple[str, Section | None, type[Section]]] = []
    for key, field in type(section).model_fields.items():
        value, name = getattr(section, key), f"{path}.{key}".lstrip(".")
        tables = sections_in(field)
        if tables and name not in usual:
            inner.append((name, value if isinstance(value, Section) else None, tables[0]))
        else:
            yield key_row(key, told_key(value, field, usual.get(name)), field)
    for name, held, model in inner:
        heading = f"[[{name}]]" if held is None else f"[{name}]"
        yield f"**`{heading}`**", "", "", "", " ".join((model.__doc__ or "").split()), ""
        if held is None:
            yield from (key_row(key, told_key(None, field, None), field) for key, field in model.model_fields.items())
        else:
            yield from rows_of(held, usual, name)


def key_row(key: str, told: Told, field: FieldInfo) -> tuple[str, ...]:
    """What is told of one key."""
    allowed = told.range or " or ".join(f"`{word}`" for word in words_of(field))
    value = "–" if told.value in (None, (), {}) or sections_in(field) else f"`{value_text(told.value)}`"
    return f"`{key}`", value, told.unit, allowed, field.description or "", told.source
