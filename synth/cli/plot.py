"""`retarder-synth plot`: pictures of exported tables; nothing is solved."""

from __future__ import annotations

import json
from pathlib import Path

from synth.cli import say


def plot_command(source: Path, output: Path, config_path: Path | None, as_json: bool) -> int:
    """Draw the tables in `source` into `output`; passes only for tables that a class of the configuration fits."""
    from synth.book.forms.table_file import file_stem, read_tables
    from synth.book.output_directory import make_directory
    from synth.cli.interrupt import interruptible
    from synth.configuration.config_file import BUILT_IN, load_config
    from synth.faults.input_error import InputError
    from synth.kernels.cache import guarded

    config = load_config(config_path)
    tables = [table for file in read_tables(source, directory_allowed=True) for table in file.tables]
    make_directory(output)
    from synth.book.validate_table import plant_for
    from synth.present.plots.figure_file import save_figure
    from synth.present.plots.table_picture import Passes, drawn_passes, table_lines, table_passes, table_surfaces
    from tuning_tables import ControllerTable

    def passes_of(table: ControllerTable) -> Passes:
        plant = plant_for(table, config, str(config_path or BUILT_IN))[1]
        return drawn_passes(table, plant, config.validation.seed)

    written: list[str] = []
    with interruptible(output):
        for table in tables:
            try:
                passes = guarded(passes_of, table)
            except InputError as fault:
                if config_path is not None:
                    raise
                say(f"no passes are drawn: {fault}")
                passes = None
            figures = {"lines": table_lines(table, passes), "surfaces": table_surfaces(table, passes)}
            if passes is not None:
                figures["passes"] = table_passes(table, passes)
            for name, figure in figures.items():
                written += map(str, save_figure(figure, output, f"{file_stem(table)}-{name}"))
    print(json.dumps({"files": written}, indent=1, ensure_ascii=False) if as_json else "\n".join(written))
    return 0
