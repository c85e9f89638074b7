"""The scripts of the page, run without it."""

from __future__ import annotations

from typing import Any

from synth.retarder.explore.explore_page import part
from tests.in_javascript import told
from tuning_tables.controller_code.js_rules import JsRules


def told_by(rules: JsRules | None, scripts: tuple[str, ...], asking: str, given: Any) -> Any:
    """What `asking`, run behind the rules and these scripts of the page, tells."""
    return told("\n".join([rules.text if rules else "", *(part(name) for name in scripts), asking]), given)
