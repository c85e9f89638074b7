"""A self-contained HTML document of sections, and the sections that every report has: pictures and files."""

from __future__ import annotations

from base64 import b64encode
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from synth.frame.page.markup import Cell, Markup, element, head_row, joined, table
from synth.frame.page.page_style import STYLE
from synth.frame.picture.picture import Picture


@dataclass(frozen=True)
class Stamp:
    """Which report it is: its title, the UTC instant, the version of the tool, and the hash of the configuration."""

    title: str
    created: str
    tool_version: str
    config_sha256: str


def document(stamp: Stamp, verdict: Markup, sections: Sequence[tuple[str, str, Markup]]) -> str:
    """One HTML document that loads nothing; `sections`: (anchor, heading, content) in the order of the page."""
    head = element(
        "head",
        element("meta", charset="utf-8"),
        element("meta", name="viewport", content="width=device-width, initial-scale=1"),
        element("title", stamp.title),
        element("style", Markup(STYLE)),
    )
    links = (element("a", name, href=f"#{anchor}") for anchor, name, _ in sections)
    body = element(
        "body",
        element("h1", stamp.title),
        element("p", f"{stamp.created} · retarder-synth {stamp.tool_version} · configuration ",
                element("code", stamp.config_sha256), class_="meta"),
        verdict,
        element("nav", *(part for link in links for part in (link, " ")), aria_label="Contents"),
        *(element("section", element("h2", name), content, id=anchor) for anchor, name, content in sections),
    )  # fmt: skip
    return f"<!DOCTYPE html>\n{element('html', head, body, lang='en')}\n"


def figure(picture: Picture) -> Markup:
    """A picture as an image of its own: the identifiers of one SVG cannot meet those of another."""
    data = b64encode(picture.svg).decode()
    image = element("img", src=f"data:image/svg+xml;base64,{data}", alt=f"{picture.title}. {picture.caption}")
    return element("figure", image, element("figcaption", picture.caption))


def file_table(file_hashes: Mapping[str, str]) -> Markup:
    """SHA-256 of every file that belongs to a report."""
    rows = [([Cell(name, kind="code"), Cell(digest, kind="code")], "") for name, digest in file_hashes.items()]
    lead = element("p", "A file belongs to this report if its SHA-256 is the one below.")
    return joined((lead, table("Hashes of files", (head_row("file", "SHA-256"),), rows, kind="files")))
