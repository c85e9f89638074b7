"""The known defects as Markdown, for the page that tells of them."""

from __future__ import annotations

from scripts.studies.study import table
from synth.frame.version import Defect, known_defects


def defects_text() -> str:
    """A row for each defect."""
    rows = [told(each) for each in known_defects()]
    head = ("id", "versions", "tables", "unsafe", "what is wrong", "at the retarder", "how to find it", "what to do")
    return table("known defects", head, rows).markdown() if rows else "None is known.\n"


def told(each: Defect) -> tuple[str, ...]:
    """The cells of a defect."""
    versions = f"from {each.introduced}" + (f", before {each.fixed}" if each.fixed else "")
    tables = f"{', '.join(each.kinds)} ({', '.join(each.steps)})"
    words = (each.wrong, each.effect, each.detect, each.remedy)
    return (each.id, versions, tables, "yes" if each.unsafe else "no", *words)
