"""The picture of the study `book`: one case of the default book."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

from matplotlib.figure import Figure

from synth.retarder.pictures.case_picture import case_picture

if TYPE_CHECKING:
    from scripts.studies.book import Results


def figures(found: Results) -> Mapping[str, Figure]:
    """The case that is shown, where the book has it."""
    return {} if found.shown is None else {"case": case_picture(found.shown)}
