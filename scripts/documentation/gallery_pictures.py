"""The pictures of a gallery program: each figure that it leaves in a name, whether pyplot knows it or not."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from matplotlib.figure import Figure


class GalleryPictures:
    """What sphinx-gallery asks after each block of a program: the pictures that it has made since the last time."""

    def __init__(self) -> None:
        self._shown: set[int] = set()

    def __repr__(self) -> str:
        return "GalleryPictures()"  # the same in each build: Sphinx compares it with that of the last one

    def __call__(self, _: Any, block_vars: dict[str, Any], gallery_conf: dict[str, Any]) -> str:
        """Save the new figures; the text that shows them."""
        from sphinx_gallery.scrapers import figure_rst

        paths = []
        for figure in self._new(block_vars["example_globals"]):
            path = str(next(block_vars["image_path_iterator"]))
            figure.savefig(path, dpi=110)
            paths.append(path)
        return str(figure_rst(paths, gallery_conf["src_dir"]))

    def _new(self, names: dict[str, Any]) -> Iterator[Figure]:
        """Figures that no earlier block has left."""
        from matplotlib.figure import Figure

        for value in names.values():
            if isinstance(value, Figure) and id(value) not in self._shown:
                self._shown.add(id(value))
                yield value
