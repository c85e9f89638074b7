"""The style sheet of the page: light, printable, tables that scroll by themselves."""

from __future__ import annotations

STYLE = """
:root { color-scheme: light; --ink: #1d2530; --soft: #5b6673; --line: #d5dbe2; --pale: #f4f6f8; --blue: #0072b2; }
* { box-sizing: border-box; }
body { margin: 0 auto; padding: 1.5rem 1.25rem 4rem; max-width: 92rem; background: #fff; color: var(--ink);
  font: 16px/1.5 system-ui, "Segoe UI", "DejaVu Sans", sans-serif; }
h1 { font-size: 1.7rem; line-height: 1.2; margin: 0 0 .4rem; }
h2 { font-size: 1.25rem; margin: 2.5rem 0 .6rem; padding-top: .6rem; border-top: 1px solid var(--line); }
h3 { font-size: 1.05rem; margin: 1.8rem 0 .5rem; }
p, ul { max-width: 62rem; margin: .5rem 0; }
.meta, figcaption, caption { color: var(--soft); font-size: .88rem; }
code, .code { font-family: ui-monospace, "DejaVu Sans Mono", monospace; font-size: .82rem; overflow-wrap: anywhere; }
nav { margin: .8rem 0; font-size: .92rem; }
nav a { margin-right: 1rem; white-space: nowrap; }
a { color: var(--blue); }
.verdict { margin: 1rem 0; padding: .7rem 1.1rem; border-left: 6px solid; background: var(--pale); }
.verdict p:first-child { font-size: 1.1rem; }
.accepted { border-color: #009e73; }
.refused { border-color: #d55e00; }
.undecided { border-color: #e69f00; }
.tiles { display: grid; grid-template-columns: repeat(auto-fit, minmax(13rem, 1fr)); gap: .8rem; margin: 1rem 0; }
.tile { padding: .7rem 1rem; background: var(--pale); border-left: 6px solid var(--line); }
.tile strong { font-size: 1.7rem; line-height: 1.2; }
.tile p { margin: .2rem 0 0; color: var(--soft); font-size: .9rem; }
.tile.accepted { border-color: #009e73; }
.tile.refused { border-color: #d55e00; }
.tile.refused strong { color: #a33f00; }
.scroll { overflow-x: auto; margin: .8rem 0; border: 1px solid var(--line); }
table { border-collapse: collapse; font-size: .82rem; font-variant-numeric: tabular-nums; width: 100%; }
caption { position: absolute; width: 1px; height: 1px; overflow: hidden; clip-path: inset(50%); }
th, td { padding: .28rem .55rem; text-align: left; border-bottom: 1px solid var(--line); vertical-align: top; }
thead th { background: var(--pale); font-weight: 600; vertical-align: bottom; }
tbody th { font-weight: 600; white-space: nowrap; background: #fff; position: sticky; left: 0; }
.cases td { text-align: right; white-space: nowrap; }
.cases td.words { text-align: left; white-space: normal; min-width: 6.5rem; }
.cases thead th { text-align: center; min-width: 4.2rem; }
.cases thead th[colspan] { border-left: 1px solid var(--line); }
.infeasible td, .infeasible th { background: #e9ebee; color: #4a535d; }
.key { font-weight: 700; }
.bad { font-weight: 700; color: #a33f00; }
.assumed td, .assumed th { background: #fff6dd; }
.mark { font-weight: 700; color: #7a4b00; }
.parameters th.code { font-weight: 500; white-space: normal; min-width: 21rem; }
figure { margin: 1.2rem 0 2rem; break-inside: avoid; }
figure img { display: block; max-width: 100%; height: auto; }
figcaption { max-width: 62rem; margin-top: .3rem; }
@page { size: landscape; margin: 12mm; }
@media print {
  body { max-width: none; padding: 0; font-size: 10pt; }
  nav { display: none; }
  .scroll { overflow: visible; border: 0; }
  .cases { font-size: 6.2pt; }
  .cases th, .cases td { padding: 1pt 1.5pt; min-width: 0 !important; white-space: normal; }
  tbody th { position: static; }
  * { -webkit-print-color-adjust: exact; print-color-adjust: exact; }
}
""".strip()
