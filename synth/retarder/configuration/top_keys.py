"""What stands at the top of every configuration of tables and trains."""

from __future__ import annotations

from plant_models.library import WEIGHT_CATEGORIES, YARD_CATEGORIES
from synth.frame.settings.section import Section, choice, many
from synth.frame.settings.value_forms import Title
from synth.retarder.configuration.named_type import named_type


class TopKeys(Section):
    """Title, and where types are from."""

    title: Title | None = choice(None, "title of the page", "…")
    library: tuple[str, ...] = many(
        (), 0, 20, "folders", "folders with your own types (docs/how-to/own-types.md)", example=["my-types/"]
    )
    weight_categories: str = named_type(YARD_CATEGORIES, WEIGHT_CATEGORIES, "the weight categories")
