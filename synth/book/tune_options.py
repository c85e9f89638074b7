"""Options of the command `tune`."""

from __future__ import annotations

from synth.frame.settings.options import Options, flag_option, number_option


class TuneOptions(Options):
    """Options of the command line."""

    workers: int | None = number_option(
        "--workers", "N", None, 1, 256, "Cut classes solved at once; by default one a processor."
    )
    pareto: bool = flag_option("--pareto", "Also tell what less time in the position costs; takes long.")
