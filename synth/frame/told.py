"""A finished run as a value: all that its page, its summary and its print are made of."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from synth.frame.command import Head, Verdict
from synth.frame.exhibits import Chapter


@dataclass(frozen=True)
class Told:
    """`command`: its name; `created`: UTC instant; `limits_of_use`: what the figures do not say."""

    command: str
    head: Head
    created: str
    verdict: Verdict
    chapters: tuple[Chapter, ...]
    limits_of_use: Sequence[str]
