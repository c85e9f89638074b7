"""What stands at the top of every configuration of tables and trains."""

from __future__ import annotations

from typing import Any

from plant_models.library import BUILT_IN, WEIGHT_CATEGORIES, YARD_CATEGORIES, Kind
from synth.frame.settings.section import Section, choice, many
from synth.frame.settings.value_forms import Title


def named_type(default: str | None, kind: Kind, meaning: str) -> Any:
    """A key that names a type, of the library or the user's own; `default` None: what it is then is told elsewhere."""
    names = BUILT_IN.names(kind)
    return choice(default, f"{meaning}; one of {', '.join(names)}, or the path of your own file", names[0])


class TopKeys(Section):
    """Title, and where types are from."""

    title: Title | None = choice(None, "title of the page", "…")
    library: tuple[str, ...] = many(
        (), 0, 20, "folders", "folders with your own types (docs/how-to/own-types.md)", example=["my-types/"]
    )
    weight_categories: str = named_type(YARD_CATEGORIES, WEIGHT_CATEGORIES, "the weight categories")
