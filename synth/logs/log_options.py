"""Options of every command on measured passes."""

from __future__ import annotations

from pathlib import Path

from synth.frame.settings.options import BY_PLACE, NEEDED, Options, word_option, words_option


class LogOptions(Options):
    """The logs, how foreign ones are read, and the configuration of the position."""

    logs: tuple[Path, ...] = words_option(BY_PLACE, "LOGS", NEEDED, "Files of measured passes, or folders of them.")
    config: Path | None = word_option("--config", "C", None, "Configuration with the plant; built-in unless given.")
    mapping: Path | None = word_option("--mapping", "FILE", None, "Names and units of foreign columns (.toml).")
