"""What `retarder-synth inspect -o DIR` draws: pictures of tables, and the tables as control loops."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

from synth.frame.input_error import InputError
from synth.frame.printed_numbers import counted
from synth.frame.terminal.manner import Manner

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from synth.cli.inspect_loops import AnyLoop
    from synth.frame.results_directory import ResultsDirectory
    from synth.frame.terminal.printed_page import Exhibit
    from synth.retarder.forms.tables_at import TablesAt

DOCUMENT: Final = "loops.json"


@dataclass(frozen=True)
class AskedDrawing:
    """Where the pictures go, whether loops are among them, and the configuration that was named."""

    output: Path
    loops: bool
    config: Path | None


@dataclass(frozen=True)
class Drawn:
    """The files that were written into `output`, and the loops."""

    output: Path
    files: tuple[str, ...]
    loops: tuple[AnyLoop, ...]

    @property
    def agrees(self) -> bool:
        """Whether python-control and the simulator agree on each loop."""
        return all(loop.agrees for loop in self.loops)

    def document(self) -> dict[str, Any]:
        """The same for programs."""
        from synth.frame.summary import plain

        found = {"pictures": list(self.files)}
        return found | {"loops": plain([loop.document for loop in self.loops])} if self.loops else found

    def page(self) -> Iterator[Exhibit]:
        """The same in words."""
        if self.loops:
            from synth.cli.inspect_loops import agreement, loops_page
            from synth.frame.terminal.printed_page import Verdict

            yield from loops_page(self.loops)
            yield Verdict(self.agrees, agreement(self.loops))
        beside = f" and {DOCUMENT}" if self.loops else ""
        yield f"{counted(len(self.files), 'picture')}{beside} in {self.output}"


def asked_drawing(output: Path | None, loops: bool, config: Path | None) -> AskedDrawing | None:
    """As it was typed; None where nothing is to be drawn. `InputError`."""
    if output is not None:
        return AskedDrawing(output, loops, config)
    if loops or config is not None:
        raise InputError(
            f"inspect {'--loops' if loops else '--config'} is about pictures; name a folder for them by -o"
        )
    return None


def draw(source: Path, tables: TablesAt, asked: AskedDrawing, manner: Manner) -> Drawn:
    """Draw the `tables` at `source`; passes and loops only for those that a class of the configuration fits."""
    from synth.frame.results_directory import results_directory
    from synth.frame.terminal.interrupt import interruptible
    from synth.retarder.forms.table_file import files_at
    from synth.retarder.tables_configuration import configuration_for

    config, place = configuration_for(asked.config, source, tables.of_stages)
    from synth.cli.inspect_loops import closing

    closings = [closing(table, config, place) for table in tables.of_stages] if asked.loops else []
    if asked.loops and not closings:
        raise InputError(f"{source}: its tables are aim tables, which regulate nothing; leave --loops out")
    from synth.cli.inspect_pictures import Surroundings, aim_figures, figures_of
    from synth.retarder.forms.table_file import file_stem

    around = Surroundings(config, place, asked.config is not None, manner)
    reads = [*files_at(source), *filter(None, [asked.config])]
    with results_directory(asked.output, "inspect", reads) as directory, interruptible(directory, "pictures"):
        files = [*written(directory, aim_figures([file.table for file in tables.aims]))]
        for table in tables.of_stages:
            stem = file_stem(table)
            files += written(directory, {f"{stem}-{name}": each for name, each in figures_of(table, around).items()})
            manner.step(f"drawn: {table.id}")
        loops = []
        for close in closings:
            loop, of_loop = loop_drawn(directory, close)
            loops.append(loop)
            files += of_loop
            manner.step(f"loop closed and drawn: {loop.table.id}")
        drawn = Drawn(asked.output, tuple(files), tuple(loops))
        if loops:
            text = json.dumps(drawn.document(), indent=1, ensure_ascii=False)
            directory.write(DOCUMENT, f"{text}\n".encode())
    return drawn


def loop_drawn(directory: ResultsDirectory, close: Callable[[], AnyLoop]) -> tuple[AnyLoop, list[str]]:
    """(the loop that `close` makes, the names of its pictures)."""
    from synth.cli.inspect_loops import pictures
    from synth.kernels.cache import guarded
    from synth.retarder.forms.table_file import file_stem

    loop = guarded(close)
    stem = file_stem(loop.table)
    return loop, written(directory, {f"{stem}-{name}": figure for name, figure in pictures(loop).items()})


def written(directory: ResultsDirectory, figures: Mapping[str, Figure]) -> list[str]:
    """The names of the files of `figures`, written."""
    from synth.frame.picture.figure_file import figure_files

    files = (directory.write_all(figure_files(figure, name)) for name, figure in figures.items())
    return [str(file) for several in files for file in several]
