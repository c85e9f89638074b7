"""JavaScript that tests run: in node where it is installed, else in a headless Chromium."""

from __future__ import annotations

import json
import re
import shutil
import subprocess
import tempfile
from base64 import b64encode
from collections.abc import Callable
from html import unescape
from pathlib import Path
from typing import Any, Final

import numpy as np
import pytest

NODE: Final = shutil.which("node")
CHROMIUM: Final = shutil.which("chromium") or shutil.which("chromium-browser") or shutil.which("google-chrome")
MOST_SECONDS: Final = 300

ARRAYS = """
const bytes = (text) => Uint8Array.from(atob(text), (letter) => letter.charCodeAt(0)).buffer;
const floats = (text) => new Float32Array(bytes(text));
const wholes = (text) => new Int32Array(bytes(text));
"""
"""What unpacks `packed` arrays."""

Engine = Callable[[str, Any], Any]
"""Runs a script: it finds `given`, and hands what it found to `tell`; both are JSON."""


def in_node(script: str, given: Any) -> Any:
    """See `Engine`."""
    assert NODE is not None
    ends = """
const given = JSON.parse(require("fs").readFileSync(0, "utf8"));
const tell = (found) => console.log(JSON.stringify(found));
"""
    done = subprocess.run(
        [NODE, "-e", ends + ARRAYS + script], input=json.dumps(given), capture_output=True, text=True, check=False,
        timeout=MOST_SECONDS,
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    return json.loads(done.stdout)


def in_chromium(script: str, given: Any) -> Any:
    """See `Engine`."""
    assert CHROMIUM is not None
    ends = """
const given = JSON.parse(document.getElementById("given").textContent);
const tell = (found) => { document.getElementById("found").textContent = JSON.stringify(found); };
"""
    data = json.dumps(given).replace("<", "\\u003c")
    page = (
        f'<!DOCTYPE html><meta charset="utf-8"><script id="given" type="application/json">{data}</script>'
        f'<pre id="found"></pre><script>{ends}{ARRAYS}{script}</script>'
    )
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "script.html"
        file.write_text(page, encoding="utf-8")
        options = ("--headless", "--no-sandbox", "--disable-gpu", "--enable-logging=stderr", "--dump-dom")
        done = subprocess.run(
            [CHROMIUM, *options, f"file://{file}"], capture_output=True, text=True, check=True, timeout=MOST_SECONDS
        )
    assert "CONSOLE" not in done.stderr, done.stderr
    (found,) = re.findall(r'<pre id="found">(.*?)</pre>', done.stdout, re.DOTALL)
    return json.loads(unescape(found))


ENGINES: Final[tuple[Engine, ...]] = (*((in_node,) if NODE else ()), *((in_chromium,) if CHROMIUM else ()))
needs_javascript = pytest.mark.skipif(not ENGINES, reason="neither node nor Chromium is installed")


def told(script: str, given: Any, engine: Engine | None = None) -> Any:
    """What the script tells, by the first engine that is there unless one is named."""
    return (engine or ENGINES[0])(script, given)


def packed(array: np.ndarray[Any, Any]) -> str:
    """float32 or whole numbers of 32 bits as text that loses no bit, NaN included: for `floats` and `wholes`."""
    kind = "<f4" if array.dtype.kind == "f" else "<i4"
    return b64encode(np.ascontiguousarray(array, dtype=kind).tobytes()).decode()
