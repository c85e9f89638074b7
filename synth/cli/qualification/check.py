"""One check of a qualification: what was looked at, how, what was found, and what it comes to."""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum
from typing import Final

from synth.frame.terminal.telling import printable
from tuning_tables.excerpt import excerpt

LONGEST: Final = 1000
"""Characters of what was found: compilers may say anything."""


class Outcome(Enum):
    """What a check comes to."""

    PASSED = "passed"
    FAILED = "failed"
    NOT_CHECKED = "not checked"


@dataclass(frozen=True)
class Check:
    """A row of the page, in words: `what` was checked, `how`, what was `found`, and the `limit` that it is held to.

    Of what could not be checked `found` is the reason, and `remedy` what would make the check possible; "" if nothing.
    """

    what: str
    how: str
    found: str
    limit: str
    outcome: Outcome
    remedy: str = ""


def checked(what: str, how: str, found: str, limit: str, holds: bool) -> Check:
    """A check that was made."""
    told = excerpt(printable(found), LONGEST)
    return Check(what, how, told, limit, Outcome.PASSED if holds else Outcome.FAILED)


def not_checked(what: str, how: str, reason: str, limit: str, remedy: str = "") -> Check:
    """A check that could not be made, with the reason."""
    return Check(what, how, reason, limit, Outcome.NOT_CHECKED, remedy)
