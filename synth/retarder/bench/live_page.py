"""The page of a run that goes on: it asks this machine again and again, and loads nothing else."""

from __future__ import annotations

from importlib.resources import files
from typing import Final

from synth.frame.page.markup import Markup, element
from synth.frame.page.scripted_document import POLICY, scripted_document

PAGE: Final = "/now"
"""Where the page asks."""


def live_page(title: str) -> bytes:
    """The whole document."""
    content = (element("h1", f"{title}: on the bench"), Markup(part("live.html")))
    policy = f"{POLICY}; connect-src 'self'"
    text = scripted_document(f"{title}: on the bench", part("live.css"), content, PAGE, [part("live.js")], policy)
    return text.encode()


def part(name: str) -> str:
    """A part of the page that is kept as a file beside this one."""
    return files("synth.retarder.bench").joinpath(name).read_text(encoding="utf-8")
