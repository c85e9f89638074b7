"""The commands that the program lists: what their entries name is there, and is that command."""

from __future__ import annotations

import pytest

from synth.cli.listed import COMMANDS, HUMP, SWEEP
from synth.frame.command_line import Listed


@pytest.mark.parametrize("listed", [*COMMANDS, *HUMP, *SWEEP], ids=lambda listed: listed.words)
def test_an_entry_names_its_command_and_the_options_of_it(listed: Listed) -> None:
    command = listed.load()
    assert command.name == listed.words
    assert command.options is listed.options()
