"""`retarder-synth init`: a file of any kind to start from, its schema, and what the library holds."""

from __future__ import annotations

import json
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from synth.cli.file_kinds import FILE_KINDS, FileKind
from synth.frame.terminal.manner import Manner

if TYPE_CHECKING:
    from plant_models.library import Kind


@dataclass(frozen=True)
class AskedFile:
    """What is typed behind `init`: the word of a kind and a name, '' for none; whether the schema is meant; the file
    that is written, None for stdout."""

    kind: str = ""
    name: str = ""
    schema: bool = False
    output: Path | None = None


def init_command(asked: AskedFile, manner: Manner) -> int:
    """Print or write the file, or its schema; `InputError` for a kind or a name that does not exist."""
    kind = kind_called(asked.kind)
    if asked.schema:
        if asked.name:  # what has no such file has no schema of it
            kind.text(asked.name)
        return give(kind, schema_text(kind), asked.output, manner)
    return give_file(kind, kind.text(asked.name), asked.output, manner)


def kind_called(word: str) -> FileKind:
    """The kind `word`; the first one where none is typed."""
    from plant_models.errors import near_miss
    from synth.frame.faults import InputError

    kinds = {kind.word: kind for kind in FILE_KINDS}
    if word and word not in kinds:
        raise InputError(f"init {word}: there is no such kind of file; {near_miss(word, kinds)}")
    return kinds[word] if word else FILE_KINDS[0]


def tables_command(trial: Path | None, position_number: int | None, asked: AskedFile, manner: Manner) -> int:
    """Give the configuration of the tables that a position needs in the hump `trial`."""
    from synth.frame.faults import InputError

    if trial is None:
        raise InputError("init --position-number is for --for TRIAL.toml, the trial whose position it is; add that")
    if asked.kind or asked.schema:
        raise InputError("init --for prints the configuration of tables for a trial; give neither a kind nor --schema")
    from synth.hump.tables_configuration import tables_toml

    return give_file(FILE_KINDS[0], tables_toml(trial, position_number), asked.output, manner)


def schema_text(kind: FileKind) -> str:
    """The schema as JSON."""
    return json.dumps(kind.schema(), indent=1, ensure_ascii=False) + "\n"


def give_file(kind: FileKind, text: str, output: Path | None, manner: Manner) -> int:
    """Print the `text` of a file, or write it, and its schema beside it; its first line names that for editors."""
    code = give(kind, f"#:schema ./{kind.schema_name}\n{text}", output, manner)
    if output is not None:
        beside = output.with_name(kind.schema_name)
        if not beside.exists():
            give(kind, schema_text(kind), beside, manner)
    return code


def give(kind: FileKind, text: str, output: Path | None, manner: Manner) -> int:
    """Print `text`, or write it into the new file `output`, in UTF-8, and print its name; a line of JSON if asked."""
    if output is None:
        told = {"kind": kind.word, "text": text}
    else:
        from synth.frame.own_files import require_new
        from tuning_tables.whole_file import write_atomically

        require_new(output)
        write_atomically(output, text.encode("utf-8"))
        told = {"kind": kind.word, "file": str(output)}
    if manner.as_json:
        print(json.dumps(told, ensure_ascii=False))
    elif output is None:
        print(text, end="")
    elif not manner.quiet:
        print(output)
    return 0


def print_list(manner: Manner) -> int:
    """The kinds of files, and what the library holds."""
    from plant_models.library.library import HUMPS, KINDS

    titles = {kind.folder: titles_of(kind) for kind in (*KINDS, HUMPS)}
    kinds = {kind.word: kind.title for kind in FILE_KINDS}
    manner.give(lambda: {"kinds": kinds, "library": titles}, lambda: list_page(kinds, titles))
    return 0


def list_page(kinds: dict[str, str], titles: dict[str, dict[str, str]]) -> list[str]:
    """The same in lines."""
    sections = {
        "Files that init prints": kinds,
        **{f"{folder} of the library": found for folder, found in titles.items()},
    }
    width = max(len(name) for found in sections.values() for name in found)
    page = []
    for heading, found in sections.items():
        page += [f"{heading}:", *(f"  {name:<{width}}  {title}" for name, title in found.items())]
    return page


def titles_of(kind: Kind) -> dict[str, str]:
    """Titles of the types of a kind by name."""
    from plant_models.library import BUILT_IN
    from plant_models.library.data_file import parse_toml

    return {name: parse_toml(BUILT_IN.file(kind, name).text)["title"] for name in BUILT_IN.names(kind)}
