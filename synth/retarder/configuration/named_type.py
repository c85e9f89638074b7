"""A key that names a type: one of the library, or the user's own."""

from __future__ import annotations

from typing import Any

from plant_models.library import BUILT_IN, Kind
from synth.frame.settings.section import choice


def named_type(default: str | None, kind: Kind, meaning: str) -> Any:
    """The declaration of such a key; `default` None: what it is then is told elsewhere."""
    names = BUILT_IN.names(kind)
    return choice(default, f"{meaning}; one of {', '.join(names)}, or the path of your own file", names[0])
