"""The JSON Schema of a configuration file, for editors that check what is typed."""

from __future__ import annotations

import json
from typing import Final

from synth.frame.settings.section import Section

DIALECT: Final = "https://json-schema.org/draft/2020-12/schema"


def schema_of(model: type[Section], title: str) -> str:
    """The schema as JSON: keys, types, limits, units, meanings and origins, as they are declared."""
    found = {"$schema": DIALECT, **model.model_json_schema(), "title": title}
    return json.dumps(found, indent=1, ensure_ascii=False) + "\n"
