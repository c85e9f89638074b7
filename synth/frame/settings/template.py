"""A commented configuration: every declared setting with its value, unit, range, meaning and origin.

It reads back to the defaults, and follows from the declarations alone.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from enum import Enum
from typing import Any, Literal, get_args, get_origin

from pydantic.fields import FieldInfo

from plant_models.library import sources_cited_in
from plant_models.library.sourced_value import JUDGEMENT
from synth.frame.settings.numbers import holds_sections
from synth.frame.settings.section import Section, setting_limits, setting_source, setting_unit
from synth.frame.settings.toml_text import value_text

HEAD = """\
# {title} (retarder-synth {command}). Every line shows its default and may be left out.
# A comment says: meaning; then unit; limits; origin. Sources stand at the end.
# ASSUMED: no citable source stands behind the number; replace it by that of your yard."""


def template(section: Section, title: str, command: str) -> str:
    """The file; `title`: of what it is a configuration, `command`: what reads it."""
    text = (HEAD.format(title=title, command=command), *section_lines(section, ""))
    return "\n".join((*text, *source_lines(text))) + "\n"


def section_lines(section: Section, path: str) -> Iterator[str]:
    """The lines of a table: its own keys first, for what follows a header belongs to it."""
    inner: list[tuple[str, Any]] = []
    for key, field in type(section).model_fields.items():
        value = getattr(section, key)
        if isinstance(value, Section) or holds_sections(value):
            inner.append((f"{path}.{key}".lstrip("."), value))
        else:
            yield from key_lines(key, value, field)
    for name, value in inner:
        if isinstance(value, Section):
            yield from ("", *notes_of(value), f"[{name}]", *section_lines(value, name))
        else:
            yield from ("", *notes_of(value[0]), *declared_lines(value[0]))
            for each in value:
                yield from (f"[[{name}]]", *given_lines(each))


def notes_of(section: Section) -> Iterator[str]:
    """What a table is for, as comments."""
    return (f"# {line.strip()}".rstrip() for line in (type(section).__doc__ or "").strip().splitlines())


def key_lines(key: str, value: Any, field: FieldInfo) -> Iterator[str]:
    """A key with its comments; one without a value stands as a comment."""
    yield from (f"# {said}" for said in said_of(field))
    if value is None:
        example = field.examples[0] if field.examples else "…"
        yield f"# {key} = {value_text(example)}"
    else:
        yield f"{key} = {value_text(value.value if isinstance(value, Enum) else value)}"


def said_of(field: FieldInfo) -> Iterator[str]:
    """The meaning of a key; unit, limits and origin; the words that it may be."""
    if field.description:
        yield field.description
    words = words_of(field)
    if words:
        yield "; ".join(value_text(word) for word in words)
    if setting_unit(field):
        limits, source = setting_limits(field), setting_source(field)
        span = f"{limits[0]:g} to {limits[1]:g}" if limits else "any"
        origin = f"ASSUMED, {source}" if source.startswith(JUDGEMENT) else source
        yield "; ".join(part for part in (setting_unit(field), span, origin) if part)


def words_of(field: FieldInfo) -> tuple[str, ...]:
    """The words that a field may be, if it takes one of a few."""
    kind = field.annotation
    if get_origin(kind) is Literal:
        return get_args(kind)
    if isinstance(kind, type) and issubclass(kind, Enum):
        return tuple(each.value for each in kind)
    return ()


def declared_lines(section: Section) -> Iterator[str]:
    """Of the tables of a list, what each key is; their values stand below."""
    for key, field in type(section).model_fields.items():
        said = tuple(said_of(field))
        if said:
            yield f"# {key}: {'; '.join(said)}"


def given_lines(section: Section) -> Iterator[str]:
    """The keys of a table of a list that have a value."""
    for key, value in section.model_dump(exclude_none=True, mode="json").items():
        yield f"{key} = {value_text(value)}"


def source_lines(text: Iterable[str]) -> Iterator[str]:
    """What is cited in `text`, as comments."""
    cited = sources_cited_in(text)
    if cited:
        yield from ("", "# Sources, by the names in [brackets]:")
        yield from (f"# [{source.name}] {source.reference}" for source in cited)
