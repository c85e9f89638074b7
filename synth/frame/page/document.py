"""A self-contained HTML document of sections, and the sections that every report has: pictures and files."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Final

from synth.frame.page.inline_svg import inline_svg
from synth.frame.page.markup import Cell, Markup, element, fold, head_row, joined, table
from synth.frame.page.page_style import STYLE
from synth.frame.picture.picture import Picture
from synth.frame.printed_numbers import counted

POLICY: Final = "default-src 'none'; style-src 'unsafe-inline'; img-src data:"
"""The browser itself keeps the page from loading anything."""


NARROW_PT: Final = 460.0
"""Two drawings that are not wider stand side by side on a screen, and three below one another on paper."""


@dataclass(frozen=True)
class Stamp:
    """Which report it is: its title, the UTC instant, the version of the tool, and the hash of the configuration, if
    there is one."""

    title: str
    created: str
    tool_version: str
    config_sha256: str = ""


def document(stamp: Stamp, first_screen: Markup, sections: Sequence[tuple[str, str, Markup]]) -> str:
    """One HTML document that loads nothing; `sections`: (anchor, heading, content) in the order of the page."""
    head = element(
        "head",
        element("meta", charset="utf-8"),
        element("meta", http_equiv="Content-Security-Policy", content=POLICY),
        element("meta", name="viewport", content="width=device-width, initial-scale=1"),
        element("title", stamp.title),
        element("style", Markup(STYLE)),
    )
    links = (element("a", name, href=f"#{anchor}") for anchor, name, _ in sections)
    body = element(
        "body",
        element("h1", stamp.title),
        element("p", f"{stamp.created} · retarder-synth {stamp.tool_version}", *of_configuration(stamp), class_="meta"),
        first_screen,
        element("nav", *(part for link in links for part in (link, " ")), aria_label="Contents"),
        *(element("section", element("h2", name), content, id=anchor) for anchor, name, content in sections),
    )  # fmt: skip
    return f"<!DOCTYPE html>\n{element('html', head, body, lang='en')}\n"


def of_configuration(stamp: Stamp) -> tuple[str, ...]:
    """The hash of the configuration in words."""
    return (" · configuration ", element("code", stamp.config_sha256)) if stamp.config_sha256 else ()


def figure(picture: Picture) -> Markup:
    """A picture with its caption."""
    drawing = inline_svg(picture.svg, picture.title, f"{picture.name}-")
    kind = "narrow" if drawing.width_pt <= NARROW_PT else ""
    return element("figure", drawing.markup, element("figcaption", picture.caption), class_=kind)


def file_table(file_hashes: Mapping[str, str]) -> Markup:
    """SHA-256 of every file that belongs to a report."""
    rows = [([Cell(name, kind="code"), Cell(digest, kind="code")], "") for name, digest in file_hashes.items()]
    lead = element("p", "A file belongs to this report if its SHA-256 is the one below.")
    hashes = table("Hashes of files", (head_row("file", "SHA-256"),), rows, kind="files")
    return joined((lead, fold(counted(len(rows), "file"), hashes)))
