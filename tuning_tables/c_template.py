"""The C text of the exports: templates in `c99/*.in`, the parts that they share, and their blanks."""

from __future__ import annotations

import re
from collections.abc import Mapping
from importlib.resources import files


def filled(name: str, blanks: Mapping[str, str]) -> str:
    """The template of the file `name` with every @include PART@ and every @BLANK@ filled."""
    text = re.sub(r"^@include (\S+)@\n", lambda found: part(found[1]), part(name), flags=re.MULTILINE)
    for blank, content in blanks.items():
        text = text.replace(f"@{blank}@", content)
    return text


def part(name: str) -> str:
    """The text of the file `name` as it stands."""
    return (files("tuning_tables") / "c99" / f"{name}.in").read_text("ascii")
