"""Options of the command `hardware`."""

from __future__ import annotations

from synth.frame.settings.options import Options, number_option


class PermissionsOptions(Options):
    """Options of the command line."""

    workers: int = number_option("--workers", "N", 2, 1, 256, "Cases compared at a time.")
