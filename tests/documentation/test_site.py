"""The site is built without a warning, and its pages are short enough to be read."""

from __future__ import annotations

import re
import shutil
import subprocess
import sys
from pathlib import Path

import nbformat
import pytest
from nbclient import NotebookClient
from sphinx_gallery.notebook import python_to_jupyter_cli

ROOT = Path(__file__).parents[2]
DOCS = ROOT / "docs"

MOST_WORDS = 60_000
NOT_READ = re.compile(
    r"<!-- (study|keys|members|studies|wires).*?<!-- end -->|^```.*?^```|^\[[\w-]+\]: \S+$", re.DOTALL | re.MULTILINE
)
"""Tables that follow from something else, listings, and where a name in brackets leads to."""


def test_the_site_is_built_without_a_warning(tmp_path: Path) -> None:
    """Every link and anchor, docstring and mark, of pages that are read and resolved, but not written.

    `scripts/site` writes them, and runs the programs of the gallery.
    """
    pages, trees = shutil.copytree(DOCS, tmp_path / "pages"), tmp_path / "trees"
    done = subprocess.run(
        [sys.executable, "-m", "sphinx", "-b", "dummy", "--quiet", "--fail-on-warning", "--keep-going",
         "-D", "plot_gallery=0", "-c", str(DOCS), "-d", str(trees), str(pages), str(tmp_path / "site")],
        text=True, check=False, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
    )  # fmt: skip
    assert done.returncode == 0, done.stdout
    for page in ("index", "reference/commands", "reference/api/synth", "made/gallery/index", "data/book"):
        assert (trees / f"{page}.doctree").is_file()
    assert b"--workers" in (trees / "reference" / "commands.doctree").read_bytes()


def test_what_is_written_by_hand_is_few_words() -> None:
    """All but pages of data, and what is made, or is no text."""
    pages = [page.read_text(encoding="utf-8") for page in DOCS.rglob("*.md") if page.parent != DOCS / "data"]
    assert sum(len(NOT_READ.sub("", page).split()) for page in pages) <= MOST_WORDS


def test_the_notebook_of_the_gallery_runs(tmp_path: Path) -> None:
    """As it is downloaded from the site, in a kernel of its own: frames are shown as tables, and pictures as such."""
    program = Path(shutil.copy(DOCS / "gallery" / "notebook.py", tmp_path))
    python_to_jupyter_cli([str(program)])
    notebook = nbformat.read(program.with_suffix(".ipynb"), as_version=4)  # type: ignore[no-untyped-call]
    NotebookClient(notebook, timeout=600, resources={"metadata": {"path": str(tmp_path)}}).execute()
    shown = [each for cell in notebook.cells if cell.cell_type == "code" for each in cell.outputs]
    assert {each.output_type for each in shown} == {"execute_result", "display_data"}, "a warning, or more is printed"
    assert sum("text/html" in each.data for each in shown) == 3
    assert sum("image/png" in each.data for each in shown) == 2


@pytest.mark.long
@pytest.mark.parametrize("program", sorted((DOCS / "gallery").glob("*.py")), ids=lambda program: program.stem)
def test_a_program_of_the_gallery_runs(program: Path, tmp_path: Path) -> None:
    """By itself, as a reader copies it; a warning is an error."""
    text = program.read_text(encoding="utf-8")
    command = [sys.executable, "-W", "error", "-c", text]
    done = subprocess.run(command, cwd=tmp_path, text=True, check=False, capture_output=True)
    assert done.returncode == 0, done.stderr
    assert list(tmp_path.iterdir()) == []
