"""What a user asks of a command: the file that he gives, and the options that he types."""

from __future__ import annotations

from pathlib import Path

from synth.frame.command import Asked, Command, O, P, R, S
from synth.frame.settings.settings_file import BUILT_IN


def asked_of(command: Command[S, O, P, R], options: O, init: str) -> Asked[S, O]:
    """The `options` that were typed, with the settings of their configuration, the defaults without one; `InputError`.

    `init`: the command that prints such a file.
    """
    path = options.config
    text, place = ("", BUILT_IN) if path is None else (command.text(path, init), str(path))
    return Asked(command.read(text, place), options, place, Path(place).parent, text)
