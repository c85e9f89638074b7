"""The first word of every name in controller code: with one of their own, two books fit into one controller."""

from __future__ import annotations

import re
from dataclasses import dataclass, replace
from typing import Final

FORM: Final = re.compile(r"[A-Za-z][A-Za-z0-9]*(_[A-Za-z0-9]+)*")
AIM: Final = "AIM"
"""The kind of aim tables, as `ExportPrefix.kind` has it."""
LONGEST: Final = 10
"""Then no name in Structured Text has more than 32 characters."""


@dataclass(frozen=True)
class ExportPrefix:
    """`text` in capitals takes the place of RETARDER, in small letters that of retarder, before every "_".

    `kind`: the word that names of a kind of tables begin with, behind the prefix; "" for those that have RETARDER.
    Raises `ValueError` for what is no identifier in C and Structured Text, or too long.
    """

    text: str = "RETARDER"
    kind: str = ""

    def __post_init__(self) -> None:
        if len(self.text) > LONGEST or FORM.fullmatch(self.text) is None:
            raise ValueError(
                f"the prefix is {self.text!r:.60}, but it must have at most {LONGEST} Latin letters, digits and single "
                "underscores between them, a letter first, such as BUNCH or TRACK_2"
            )
        if re.search(rf"(^|_){AIM}$", self.text, re.IGNORECASE):
            raise ValueError(f"the prefix is {self.text!r}, but it must not end with {AIM}, which names aim tables")

    @property
    def is_default(self) -> bool:
        """Whether all names stay as they are."""
        return self.text.upper() == ExportPrefix.text

    def renamed(self, code: str) -> str:
        """`code`, or the name of a file, with this prefix; ids of tables stay, for `comment_text` sees to it."""
        word = "_".join(filter(None, ("" if self.kind and self.is_default else self.text, self.kind)))
        code = re.sub(r"\bRETARDER_", f"{word.upper()}_", code)
        return re.sub(r"\bretarder_", f"{word.lower()}_", code)

    def of_kind(self, kind: str) -> ExportPrefix:
        """The prefix for a kind whose names begin with a word of its own."""
        return replace(self, kind=kind)

    def data_file(self, name: str) -> str:
        """The name of a file beside the code that holds no code."""
        return name if self.is_default else f"{self.text.lower()}_{name}"


RETARDER: Final = ExportPrefix()
"""That of every export for which none is asked."""
