"""The site is built without a warning, and its pages are short enough to be read."""

from __future__ import annotations

import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
DOCS = ROOT / "docs"

MOST_WORDS = 60_000
NOT_READ = re.compile(
    r"<!-- (study|keys|members|studies).*?<!-- end -->|^```.*?^```|^\[[\w-]+\]: \S+$", re.DOTALL | re.MULTILINE
)
"""Tables that follow from something else, listings, and where a name in brackets leads to."""


def test_the_site_is_built_without_a_warning(tmp_path: Path) -> None:
    """Every link and anchor, docstring and mark; the programs of the gallery run when `scripts/site` builds it."""
    pages = shutil.copytree(DOCS, tmp_path / "pages")
    done = subprocess.run(
        [sys.executable, "-m", "sphinx", "--quiet", "--fail-on-warning", "--keep-going", "-D", "plot_gallery=0",
         "-c", str(DOCS), "-d", str(tmp_path / "trees"), str(pages), str(tmp_path / "site")],
        text=True, check=False, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
    )  # fmt: skip
    assert done.returncode == 0, done.stdout
    for page in ("index", "reference/commands", "reference/api/synth", "made/gallery/index", "data/book"):
        assert (tmp_path / "site" / f"{page}.html").is_file()
    commands = (tmp_path / "site" / "reference" / "commands.html").read_text(encoding="utf-8")
    assert "--workers" in commands


def test_what_is_written_by_hand_is_few_words() -> None:
    """All but pages of data, and what is made, or is no text."""
    pages = [page.read_text(encoding="utf-8") for page in DOCS.rglob("*.md") if page.parent != DOCS / "data"]
    assert sum(len(NOT_READ.sub("", page).split()) for page in pages) <= MOST_WORDS


@pytest.mark.long
@pytest.mark.parametrize("program", sorted((DOCS / "gallery").glob("*.py")), ids=lambda program: program.stem)
def test_a_program_of_the_gallery_runs(program: Path, tmp_path: Path) -> None:
    """By itself, as a reader copies it; a warning is an error."""
    text = program.read_text(encoding="utf-8")
    command = [sys.executable, "-W", "error", "-c", text]
    done = subprocess.run(command, cwd=tmp_path, text=True, check=False, capture_output=True)
    assert done.returncode == 0, done.stderr
    assert list(tmp_path.iterdir()) == []
