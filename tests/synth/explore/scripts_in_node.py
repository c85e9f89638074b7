"""The scripts of the page in node: what they print for what they are given."""

from __future__ import annotations

import json
import shutil
import subprocess
from base64 import b64encode
from typing import Any

import numpy as np
import pytest

from synth.retarder.explore.explore_page import part
from tuning_tables.controller_code.js_rules import JsRules

NODE = shutil.which("node")
needs_node = pytest.mark.skipif(NODE is None, reason="node is not installed")

HEAD = """
const given = JSON.parse(require("fs").readFileSync(0, "utf8"));
const floats = (text) => new Float32Array(Uint8Array.from(Buffer.from(text, "base64")).buffer);
const tell = (found) => console.log(JSON.stringify(found));
"""


def told(rules: JsRules | None, scripts: tuple[str, ...], asking: str, given: Any) -> Any:
    """What `asking`, run behind the rules and these scripts of the page, hands to `tell`."""
    assert NODE is not None
    text = "\n".join([rules.text if rules else "", *(part(name) for name in scripts), HEAD, asking])
    done = subprocess.run(
        [NODE, "-e", text], input=json.dumps(given), capture_output=True, text=True, check=False, timeout=300
    )
    assert done.returncode == 0, done.stderr
    return json.loads(done.stdout)


def packed(array: np.ndarray[Any, Any]) -> str:
    """float32 numbers as text that loses no bit, NaN included."""
    return b64encode(np.ascontiguousarray(array, dtype="<f4").tobytes()).decode()
