"""A commented configuration: every declared setting with its value, unit, range, meaning and origin; and a
configuration written as TOML, so that a command can be given a condition of a sweep.

It reads back to the defaults, and follows from the declarations, and from what the library has in place of keys that
are left out.
"""

from __future__ import annotations

import json
from collections.abc import Iterable, Iterator
from types import MappingProxyType
from typing import Any, Final

from pydantic.fields import FieldInfo

from plant_models.library import sources_cited_in
from synth.frame.settings.numbers import Told, Usual, told_key, whole, words_of
from synth.frame.settings.section import Section, sections_in
from synth.frame.settings.settings_file import dotted_keys, field_at


def toml_text(tree: dict[str, Any]) -> str:
    """`tree` of tables, lists of tables, lists, strings, numbers and truth values; `tomllib` reads it back the same."""
    return "\n".join(table_lines(tree, "")) + "\n"


def table_lines(tree: dict[str, Any], prefix: str) -> Iterator[str]:
    """The lines of one table: plain keys first, for what follows a header belongs to it."""
    for key, value in tree.items():
        if not isinstance(value, dict) and not is_table_list(value):
            yield f"{key_text(key)} = {value_text(value)}"
    for key, value in tree.items():
        name = f"{prefix}{key_text(key)}"
        if isinstance(value, dict):
            yield f"\n[{name}]"
            yield from table_lines(value, f"{name}.")
        elif is_table_list(value):
            for item in value:
                yield f"\n[[{name}]]"
                yield from table_lines(item, f"{name}.")


def is_table_list(value: object) -> bool:
    """A list of tables, which has a header an item."""
    return isinstance(value, list) and bool(value) and all(isinstance(item, dict) for item in value)


def key_text(key: str) -> str:
    """A key, in quotes where it is no bare one."""
    bare = key and all(part.isascii() and (part.isalnum() or part in "_-") for part in key)
    return key if bare else value_text(key)


def value_text(value: Any) -> str:
    """A value within a line."""
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, str):
        return json.dumps(value, ensure_ascii=False).replace("\x7f", "\\u007f")
    if isinstance(value, list | tuple):
        return f"[{', '.join(value_text(item) for item in value)}]"
    if isinstance(value, dict):
        return f"{{{', '.join(f'{key_text(key)} = {value_text(item)}' for key, item in value.items())}}}"
    return repr(value)


HEAD = """\
# {title} (retarder-synth {command}). {lines}
# A comment says: meaning; then unit; limits, or of a number of the library its sensible range; origin. Sources stand
# at the end. ASSUMED: no citable source stands behind the number; replace it by that of your yard."""

DEFAULTS: Final = "Every line shows its default and may be left out."

NOTHING: Final[Usual] = MappingProxyType({})


def template(
    section: Section,
    title: str,
    command: str,
    usual: Usual = NOTHING,
    notes: Iterable[str] = (),
    lines: str = DEFAULTS,
) -> str:
    """The file; `title`: of what it is a configuration, `command`: what reads it, `usual`: what the library has in
    place of keys that are left out, `notes`: on what it has, `lines`: what its values are."""
    noted = (f"# Note: {note}" for note in notes)
    text = (HEAD.format(title=title, command=command, lines=lines), *noted, *section_lines(section, "", usual))
    return "\n".join((*text, *source_lines(text))) + "\n"


def section_lines(section: Section, path: str, usual: Usual) -> Iterator[str]:
    """The lines of a table: its own keys first, for what follows a header belongs to it."""
    tables: list[tuple[str, Any, FieldInfo]] = []
    for key, field in type(section).model_fields.items():
        value, name = getattr(section, key), f"{path}.{key}".lstrip(".")
        if sections_in(field) and name not in usual:
            tables.append((name, value, field))
        else:
            yield from key_lines(key, told_key(value, field, usual.get(name)), field)
    for name, value, field in tables:
        if isinstance(value, Section):
            yield from ("", *notes_of(type(value)), f"[{name}]", *section_lines(value, name, usual))
        elif value is None:
            yield from ("", f"# [{name}]: {field.description}")
        elif value:
            yield from list_lines(name, value, usual, "")
        elif field.examples:
            yield from list_lines(name, field.examples[0], usual, "# ")


def list_lines(name: str, tables: tuple[Section, ...], usual: Usual, mark: str) -> Iterator[str]:
    """A list of tables: what it is for, what each key is, and behind `mark` the tables."""
    yield from ("", *notes_of(type(tables[0])), *declared_lines(type(tables[0])))
    for place, each in enumerate(tables):
        if place:
            yield ""
        yield f"{mark}[[{name}]]"
        yield from (f"{mark}{line}" for line in given_lines(each, f"{name}[{place}].", usual))


def notes_of(section: type[Section]) -> Iterator[str]:
    """What a table is for, as comments."""
    return (f"# {line.strip()}".rstrip() for line in (section.__doc__ or "").strip().splitlines())


def key_lines(key: str, told: Told, field: FieldInfo) -> Iterator[str]:
    """A key with its comments; with an example in place of a value it stands as a comment, with neither not at all."""
    if told.value not in (None, (), {}):
        yield from (f"# {said}" for said in said_of(field, told))
        yield from assigned_lines(key, told.value, "# " if sections_in(field) else "")
    elif field.examples:
        yield from (f"# {said}" for said in said_of(field, told))
        yield f"# {key} = {value_text(field.examples[0])}"


def assigned_lines(key: str, value: Any, mark: str) -> Iterator[str]:
    """`key = value`, each line behind `mark`; rows of a table in a line each."""
    if isinstance(value, list):
        yield from (f"{mark}{key} = [", *(f"{mark}    {value_text(row)}," for row in value), f"{mark}]")
    else:
        yield f"{mark}{key} = {value_text(value)}"


def said_of(field: FieldInfo, told: Told) -> Iterator[str]:
    """The meaning of a key; the words that it may be; unit, range and origin."""
    if field.description:
        yield field.description
    words = words_of(field)
    if words:
        yield "; ".join(value_text(word) for word in words)
    if told.origin:
        yield told.origin


def declared_lines(section: type[Section]) -> Iterator[str]:
    """Of the tables of a list, what each key is; their values stand below."""
    for key, field in section.model_fields.items():
        said = tuple(said_of(field, told_key(None, field, None)))
        if said:
            yield f"# {key}: {'; '.join(said)}"


def given_lines(section: Section, path: str, usual: Usual) -> Iterator[str]:
    """The keys of a table of a list that have a value; then, as comments, those that follow from them."""
    given = section.model_dump(exclude_none=True, mode="json")
    for key, value in given.items():
        if value != {}:
            yield f"{key} = {value_text(value)}" + behind(usual.get(path + key))
    for key in dotted_keys(type(section), ""):
        told = usual.get(path + key)
        if told is not None and given.get(key.partition(".")[0]) in (None, {}):
            value = whole(told.value, field_at(key.split("."), type(section)))
            yield f"# {key} = {value_text(value)}" + behind(told)


def behind(told: Told | None) -> str:
    """The origin of a number, behind it in its line."""
    return f"  # {told.origin}" if told is not None and told.origin else ""


def source_lines(text: Iterable[str]) -> Iterator[str]:
    """What is cited in `text`, as comments."""
    cited = sources_cited_in(text)
    if cited:
        yield from ("", "# Sources, by the names in [brackets]:")
        yield from (f"# [{source.name}] {source.reference}" for source in cited)
