"""Types of one's own in files, and the configurations that use them."""

from __future__ import annotations

from pathlib import Path

import pytest

from plant_models.library import Kind
from synth.cli.type_template import type_toml
from synth.frame.input_error import InputError
from synth.retarder.configuration.config_file import load_config
from synth.retarder.configuration.resolved_config import ResolvedConfig

CUT = '[[cut]]\ncar = "gondola-4"\nmass_t = 22\n'


def own(folder: Path, kind: Kind, name: str, **changes: str) -> Path:
    """A file as init prints it under another name; `changes`: lines by the key that they begin with."""
    lines = type_toml(kind, None).splitlines()
    for key, line in changes.items():
        (place,) = (i for i, text in enumerate(lines) if text.startswith(f"{key} "))
        lines[place] = line
    path = folder / kind.folder / f"{name}.toml"
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text("\n".join(lines), encoding="utf-8")
    return path


def config_in(folder: Path, text: str) -> ResolvedConfig:
    """The configuration `text` as a file in `folder`."""
    path = folder / "my.toml"
    path.write_text(text, encoding="utf-8")
    return load_config(path)


def sentences(folder: Path, text: str) -> tuple[str, ...]:
    """What is said of the faulty configuration `text`."""
    with pytest.raises(InputError) as caught:
        config_in(folder, text)
    return caught.value.sentences


def number(key: str, value: object, span: str = "[0.0, 1000.0]") -> str:
    """The line of a number."""
    return f'{key} = {{ value = {value}, range = {span}, source = "test", confidence = "L" }}'
