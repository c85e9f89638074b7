"""Numbers of weight categories in tables and controller code, as docs/reference/table-format.md fixes them."""

from __future__ import annotations

from typing import Any, Final

from synth.checker.document_shape import refuse_unless

YARD: Final = {"Л": 1, "ЛС": 2, "С": 3, "СТ": 4, "Т": 5}
OWN: Final = range(16, 256)


def number_of(cut: dict[str, Any]) -> int | None:
    """The number of the category of a cut: stated, or that of the yard's own; None for neither.

    Raises `DamagedError` where another one is stated.
    """
    stated, known = cut.get("category_number"), YARD.get(cut["category"])
    if stated is None:
        return known
    right = stated == known if known is not None else stated in OWN
    wanted = str(known) if known is not None else "from 16 to 255"
    refuse_unless(right, stated, f"cut.category_number of {cut['category']}", wanted)
    return int(stated)
