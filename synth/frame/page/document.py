"""HTML documents that load nothing: one of sections with the parts that every report has, one with scripts and
data of its own, and the style sheet of all: light or dark as the reader has it, printable, tables that scroll by
themselves.
"""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from importlib.resources import files
from typing import Final

from synth.frame.page.markup import Cell, Markup, element, fold, head_row, inline_svg, joined, table
from synth.frame.picture.picture import DARKENED, Picture
from synth.frame.printed_numbers import counted

STYLE = f"""
:root {{ color-scheme: light dark; --ground: #fff; --ink: #1d2530; --soft: #5b6673; --line: #d5dbe2; --pale: #f4f6f8;
  --blue: #0072b2; --good: #009e73; --bad: #d55e00; --open: #e69f00; --bad-ink: #a33f00; --mark: #7a4b00;
  --assumed: #fff6dd; --drawing: none; }}
@media (prefers-color-scheme: dark) {{
  :root {{ --ground: #141414; --ink: #e4e7ea; --soft: #a3adb8; --line: #3a4149; --pale: #20252b; --blue: #6cb8ec;
    --good: #1fbf91; --bad: #f0813a; --open: #e6b04a; --bad-ink: #ff9d66; --mark: #f0c26b; --assumed: #35301d;
    --drawing: {DARKENED}; }}
}}
* {{ box-sizing: border-box; }}
body {{ margin: 0 auto; padding: 1.25rem 1.25rem 4rem; max-width: 92rem; background: var(--ground); color: var(--ink);
  font: 16px/1.5 system-ui, "Segoe UI", "DejaVu Sans", sans-serif; }}
h1 {{ font-size: 1.6rem; line-height: 1.2; margin: 0 0 .3rem; overflow-wrap: anywhere; }}
h2 {{ font-size: 1.25rem; margin: 2.2rem 0 .6rem; padding-top: .6rem; border-top: 1px solid var(--line); }}
h3 {{ font-size: 1.05rem; margin: 1.4rem 0 .5rem; }}
p, ul, ol {{ max-width: 62rem; margin: .5rem 0; }}
ul, ol {{ padding-left: 1.4rem; }}
.facts {{ max-width: none; font-size: .92rem; list-style: none; padding-left: .8rem; }}
.meta, figcaption, caption {{ color: var(--soft); font-size: .88rem; }}
code, .code {{ font-family: ui-monospace, "DejaVu Sans Mono", monospace; font-size: .82rem; overflow-wrap: anywhere; }}
nav {{ margin: .8rem 0; font-size: .92rem; }}
nav a {{ margin-right: 1rem; }}
a {{ color: var(--blue); }}
.verdict, .to-do {{ margin: .8rem 0; padding: .6rem 1.1rem; border-left: 6px solid var(--line);
  background: var(--pale); }}
.verdict > p {{ font-size: 1.2rem; }}
.verdict ul, .to-do ol {{ margin: .2rem 0; }}
.accepted {{ border-color: var(--good); }}
.refused {{ border-color: var(--bad); }}
.undecided {{ border-color: var(--open); }}
.tiles {{ display: grid; grid-template-columns: repeat(auto-fit, minmax(12rem, 1fr)); gap: .8rem; margin: .8rem 0; }}
.tile {{ padding: .6rem 1rem; background: var(--pale); border-left: 6px solid var(--line); }}
.tile strong {{ font-size: 1.6rem; line-height: 1.2; }}
.tile p {{ margin: .2rem 0 0; color: var(--soft); font-size: .9rem; }}
.tile.accepted {{ border-color: var(--good); }}
.tile.refused {{ border-color: var(--bad); }}
.tile.undecided {{ border-color: var(--open); }}
.tile.refused strong {{ color: var(--bad-ink); }}
details {{ margin: .8rem 0; }}
summary {{ cursor: pointer; color: var(--blue); max-width: 62rem; }}
.scroll {{ overflow-x: auto; margin: .8rem 0; border: 1px solid var(--line); }}
table {{ border-collapse: collapse; font-size: .82rem; font-variant-numeric: tabular-nums; width: 100%; }}
caption {{ position: absolute; width: 1px; height: 1px; overflow: hidden; clip-path: inset(50%); }}
th, td {{ padding: .28rem .55rem; text-align: left; border-bottom: 1px solid var(--line); vertical-align: top; }}
thead th {{ background: var(--pale); font-weight: 600; vertical-align: bottom; }}
tbody th {{ font-weight: 600; white-space: nowrap; background: var(--ground); position: sticky; left: 0; }}
.cases td {{ text-align: right; white-space: nowrap; }}
.cases td.words {{ text-align: left; white-space: normal; min-width: 6.5rem; }}
.cases thead th {{ text-align: center; min-width: 4.2rem; }}
.bad {{ font-weight: 700; color: var(--bad-ink); }}
.assumed td, .assumed th {{ background: var(--assumed); }}
.mark {{ font-weight: 700; color: var(--mark); }}
.parameters th.code {{ font-weight: 500; white-space: normal; min-width: 21rem; }}
.figures {{ display: flex; flex-wrap: wrap; gap: .6rem 1.2rem; align-items: flex-start; }}
figure {{ margin: .8rem 0; max-width: 100%; width: min-content; break-inside: avoid; }}
figure svg {{ filter: var(--drawing); display: block; max-width: calc(100vw - 2.5rem); height: auto; }}
figcaption {{ margin-top: .2rem; }}
@media (max-width: 40rem) {{
  body {{ padding: .8rem 1.25rem 3rem; }}
  tbody th {{ white-space: normal; min-width: 6rem; }}
  .parameters th.code {{ min-width: 9rem; }}
  .tiles {{ grid-template-columns: 1fr 1fr; }}
  figure {{ width: auto; overflow-x: auto; }}
  figure:not(.narrow) svg {{ max-width: 46rem; }}
}}
@page {{ size: A4; margin: 12mm; }}
@media print {{
  :root {{ color-scheme: light; --ground: #fff; --ink: #1d2530; --soft: #5b6673; --line: #d5dbe2; --pale: #f4f6f8;
    --blue: #0072b2; --assumed: #fff6dd; --bad-ink: #a33f00; --mark: #7a4b00;
    --drawing: none; }}
  body {{ max-width: none; padding: 0; font-size: 9.5pt; }}
  nav {{ display: none; }}
  summary {{ color: var(--soft); font-size: 8.5pt; }}
  h2 {{ margin-top: 1.2rem; }}
  .scroll {{ overflow: visible; border: 0; }}
  .cases {{ font-size: 6.5pt; }}
  .cases th, .cases td {{ padding: 1pt 2pt; min-width: 0 !important; white-space: normal; }}
  tbody th {{ position: static; }}
  .figures {{ gap: 0 4mm; }}
  figure {{ margin: 1mm 0; width: auto; }}
  .narrow {{ width: 138mm; }}
  figure svg {{ max-width: 100%; }}
  figcaption {{ font-size: 7.5pt; }}
  * {{ -webkit-print-color-adjust: exact; print-color-adjust: exact; }}
}}
""".strip()


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
