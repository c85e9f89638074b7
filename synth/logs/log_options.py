"""Options of the commands on measured passes."""

from __future__ import annotations

from pathlib import Path

from synth.frame.settings.options import BY_PLACE, NEEDED, Options, word_option, words_option


class LogOptions(Options):
    """The logs, how foreign ones are read, and the configuration of the position."""

    logs: tuple[Path, ...] = words_option(BY_PLACE, "LOGS", NEEDED, "Files of measured passes, or folders of them.")
    config: Path | None = word_option("--config", "C", None, "Configuration with the plant; built-in unless given.")
    mapping: Path | None = word_option("--mapping", "FILE", None, "Names and units of foreign columns (.toml).")


class WatchOptions(LogOptions):
    """Options of the command line."""

    reference: tuple[Path, ...] = words_option(
        "--reference", "LOG", (), "Passes known to be in order: drifts are counted from their numbers."
    )


class ReplayOptions(LogOptions):
    """Options of the command line."""

    table: Path = word_option("--table", "TABLE|BOOK|DIR", NEEDED, "The tables to try.")
    own: Path | None = word_option(
        "--own", "TABLE|BOOK|DIR", None, "What drove the log; the configuration's own tables unless given."
    )


class RetuneOptions(LogOptions):
    """Options of the command line."""

    table: Path | None = word_option(
        "--table", "TABLE|BOOK|DIR", None, "What runs now; the configuration's own tables unless given."
    )
