"""Options of the command `qualify`."""

from __future__ import annotations

from typing import ClassVar

from synth.frame.settings.options import Options


class QualifyOptions(Options):
    """None but what all commands have: the problem is the program's own."""

    config: ClassVar[None] = None  # type: ignore[misc]  # no file is asked for, so there is no such option
