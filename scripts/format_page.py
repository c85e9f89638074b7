"""The tables of docs/reference/table-format.md that follow from the declared members: one for each kind of table.

`python -m scripts.format_page` writes them anew into the page, between the marks that stand there.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path
from typing import Final

from tuning_tables.declared.members import LeafMember, SectionMember, members_of
from tuning_tables.document import KINDS
from tuning_tables.units import NO_UNIT, unit_of

PAGE: Final = Path(__file__).parents[1] / "docs" / "reference" / "table-format.md"
MARKED: Final = re.compile(r"(<!-- members: (\w+) -->\n).*?(<!-- end -->)", re.DOTALL)
HEAD: Final = "| key | is | unit | allowed |\n|---|---|---|---|\n"


def updated(page: str) -> str:
    """The text of the page with the tables that follow from the declarations."""
    return MARKED.sub(lambda mark: f"{mark[1]}{HEAD}{''.join(_rows(KINDS[mark[2]], ''))}{mark[3]}", page)


def _rows(declared: type, prefix: str) -> Iterator[str]:
    """A row for each member, and for each of its own."""
    for name, member in members_of(declared).items():
        key = f"{prefix}{name}"
        match member:
            case LeafMember():
                leaf = member.leaf
                unit = leaf.unit or unit_of(name)
                allowed = f"{leaf.allowed}, or null" if member.is_optional else leaf.allowed
                yield f"| `{key}` | {leaf.meaning} | {'' if unit == NO_UNIT else unit} | {allowed} |\n"
            case SectionMember():
                meaning = member.meaning.rstrip(".")
                yield f"| `{key}` | {meaning} | | {'an object, or null' if member.is_optional else 'an object'} |\n"
                yield from _rows(member.section, f"{key}.")
            case _:
                several = member.several
                yield f"| `{key}` | {several.meaning} | | {several.fewest} to {several.most} objects |\n"
                yield from _rows(member.section, f"{key}[].")


if __name__ == "__main__":
    PAGE.write_text(updated(PAGE.read_text(encoding="utf-8")), encoding="utf-8")
