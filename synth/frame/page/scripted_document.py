"""An HTML document with scripts and data of its own, which loads nothing: the browser itself keeps it from that."""

from __future__ import annotations

import json
from collections.abc import Sequence
from importlib.resources import files
from typing import Final

from synth.frame.page.markup import Markup, element
from synth.frame.page.page_style import STYLE

SPEED_UNITS: Final = files("synth.frame.page").joinpath("speed_units.js").read_text(encoding="utf-8")
"""The script of pages whose user chooses the unit of speeds."""

SCRIPT_POLICY: Final = "default-src 'none'; style-src 'unsafe-inline'; script-src 'unsafe-inline'; img-src data:"
"""Of the security of its content."""


def scripted_document(
    title: str, style: str, content: Sequence[Markup], data: object, scripts: Sequence[str], policy: str = SCRIPT_POLICY
) -> str:
    """One document: `content`, then `data` in the element "data", then `scripts` in their order.

    `style` comes behind that of every page; `policy`: what the browser lets it load. The same arguments give the same
    text.
    """
    head = element(
        "head",
        element("meta", charset="utf-8"),
        Markup(f'<meta http-equiv="Content-Security-Policy" content="{policy}">'),
        element("meta", name="viewport", content="width=device-width, initial-scale=1"),
        element("title", title),
        element("style", Markup(f"{STYLE}\n{style}")),
    )
    body = element(
        "body",
        *content,
        element("script", Markup(script_safe(data)), id="data", type="application/json"),
        *(element("script", Markup(text)) for text in scripts),
    )
    return f"<!DOCTYPE html>\n{element('html', head, body, lang='en')}\n"


def script_safe(data: object) -> str:
    """JSON in which nothing can end the script element that holds it."""
    text = json.dumps(data, ensure_ascii=True, separators=(",", ":"), allow_nan=False)
    return text.replace("<", "\\u003c").replace(">", "\\u003e").replace("&", "\\u0026")
