"""The page on hump files: its two files are read, and are what the text around them says."""

from __future__ import annotations

import re
from pathlib import Path

from synth.hump.hump_file import parse_hump
from synth.hump.making.hump_toml import hump_toml
from synth.hump.making.short_file import read_short_hump

PAGE = (Path(__file__).parents[3] / "docs" / "reference" / "hump-file.md").read_text(encoding="utf-8")


def test_the_files_on_the_page() -> None:
    short, text = re.findall(r"```toml\n(.*?)```", PAGE, re.DOTALL)
    made = parse_hump(hump_toml(read_short_hump(short, "short.toml"), "short.toml"), "made", "made.toml")
    assert (len(made.graph.tracks), len(made.graph.switches)) == (16, 15)
    hump = parse_hump(text, "page", "page.toml")
    assert hump.graph.incidence[1] == (2, 3)
    assert [route.code for route in hump.graph.routes(201).values()] == ["00", "01", "10", "11"]
    assert hump.graph.route(201, 2).free_to_m == 40 + 34 + 34 + 400 - 120
    assert [each.exit_std_m_s for each in hump.graph.retarders] == [0.15]
    assert all(value.assumed or value.source.startswith("data sheet") for value in hump.provenance)
