"""How Sphinx makes the documentation site of the pages in this folder; `scripts/site` does it.

The lists of commands and of Python names are made here, of the program itself. Nothing is fetched from a network, while
the site is built or while it is read.
"""

from __future__ import annotations

import re
import sys
from importlib.metadata import version as installed_version
from pathlib import Path
from typing import Any

DOCS = Path(__file__).resolve().parent
sys.path.insert(0, str(DOCS.parent))

from scripts.documentation.api_page import api_text  # noqa: E402
from scripts.documentation.commands_page import commands_text  # noqa: E402
from scripts.documentation.gallery_pictures import GalleryPictures  # noqa: E402
from scripts.documentation.known_defects_page import defects_text  # noqa: E402
from scripts.documentation.requirements import PAGE as REQUIREMENTS  # noqa: E402
from scripts.documentation.requirements import with_proofs  # noqa: E402

project = "retarder-synth"
author = "the developers of retarder-synth"
project_copyright = "the developers of retarder-synth, Apache-2.0"
version = release = installed_version(project)
language = "en"

extensions = ["myst_parser", "sphinx.ext.autodoc", "sphinx.ext.napoleon", "sphinx_gallery.gen_gallery"]
exclude_patterns = ["examples", "studies", "gallery", "sg_execution_times.rst"]
myst_heading_anchors = 4
suppress_warnings = ["misc.highlighting_failure"]  # examples of files leave out what repeats, with an ellipsis

autodoc_typehints = "description"
autodoc_typehints_description_target = "documented"
default_role = "code"  # single backticks of docstrings
autodoc_member_order = "bysource"
napoleon_google_docstring = False

sphinx_gallery_conf = {
    "examples_dirs": ["gallery"],
    "gallery_dirs": ["made/gallery"],
    "filename_pattern": r"\.py$",
    "image_scrapers": (GalleryPictures(),),
    "within_subsection_order": "ExampleTitleSortKey",
    "show_memory": False,
    "show_signature": False,
    "download_all_examples": False,
    "abort_on_example_error": True,
    "capture_repr": ("_repr_html_",),  # datasets and data frames
}

html_theme = "furo"
html_title = f"{project} {version}"
html_static_path = ["_static"]
html_css_files = ["site.css"]
html_show_sourcelink = False

API = re.compile(r"<!-- api (\S+) -->\n")
COMMANDS = "<!-- commands -->\n"
DEFECTS = "<!-- known defects -->\n"
"""Marks in pages: the public names of a package, all commands, and the known defects stand in their place."""


def setup(app: Any) -> None:
    """Have marks replaced in every page that is read."""
    app.connect("source-read", fill_marks)


def fill_marks(_: Any, page: str, source: list[str]) -> None:
    """Replace the marks of one page; requirements get their tests."""
    text = API.sub(lambda mark: api_text(mark[1]), source[0])
    text = with_proofs(text) if page == REQUIREMENTS else text.replace(DEFECTS, defects_text())
    source[0] = text.replace(COMMANDS, commands_text("..")) if COMMANDS in text else text
