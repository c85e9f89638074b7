"""The controller as a unit: the exported C of a book, its rule, and the variables that an importer connects."""

from __future__ import annotations

from dataclasses import replace
from typing import Final

from synth.retarder.fmi.unit import Unit, c_part
from synth.retarder.fmi.variables import Causality, Kind, Variable
from tuning_tables.controller_code.c_code import c_header, c_source
from tuning_tables.controller_code.line_code import NAMED, line_code
from tuning_tables.export_names import ExportPrefix
from tuning_tables.self_test_size import SMALL
from tuning_tables.stage import MOST_STAGES
from tuning_tables.table_book import TableBook

MEANING: Final = (
    "Controller of a car retarder: from path, measured speed and pressure to the stage to command. One step is one "
    "sample of the radar, with the period that the tables were made for. The decision at the beginning of a step is "
    "the output at its end. The controller steps first, then the position, with the stage of this same step."
)


def controller_unit(book: TableBook, prefix: ExportPrefix) -> Unit:
    """The unit of all tables of a book; raises as `line_code`."""
    code = line_code(book, SMALL)
    texts = {
        f"retarder_{code.stem}.h": c_header(code),
        f"retarder_{code.stem}.c": c_source(code),
        "memory.h": c_part("controller_memory.h"),
        "controller.c": c_part("controller.c"),
    }
    return Unit(
        identifier=prefix.renamed("retarder_controller"),
        name=f"{prefix.renamed('retarder_controller')} of {book.tables[0].retarder.name}",
        meaning=MEANING,
        own=(*INPUTS, *parameters(book), *OUTPUTS),
        c={prefix.renamed(name): prefix.renamed(text) for name, text in texts.items()},
        period_s=book.tables[0].clock.sample_period_s,
    )


MOST_AXLES: Final = 10_000
MOST_M_S: Final = 40.0
"""Beyond any cut: limits for whoever asks for them; the choice of a table tells what it has."""

INPUTS: Final = (
    Variable("path_m", Kind.FLOAT64, Causality.INPUT,
             "path of the first axle from the entrance of the first retarder, negative before it", (0.0,), "m"),
    Variable("measured_m_s", Kind.FLOAT64, Causality.INPUT,
             "speed that the radar shows; -1 for a missing reading", (-1.0,), "m/s"),
    Variable("mean_overpressure_kpa", Kind.FLOAT64, Causality.INPUT,
             "mean since the last sample of the pressure above that at which the pads touch; for an estimator",
             (0.0,), "kPa"),
    Variable("pressure_kpa", Kind.FLOAT64, Causality.INPUT,
             "pressure that the gauge shows; for tables with slopes", (0.0,), "kPa"),
    Variable("at_rest", Kind.BOOLEAN, Causality.INPUT,
             "whether the pressure of the commanded stage is reached; tables that decide at any time do not look at it",
             (False,)),
)  # fmt: skip

OUTPUTS: Final = (
    Variable("stage", Kind.INT32, Causality.OUTPUT, "commanded stage"),
    Variable("speed_m_s", Kind.FLOAT64, Causality.OUTPUT,
             "speed that the lines were compared with; -1 before any was measured", unit="m/s"),
    Variable("choice", Kind.INT32, Causality.OUTPUT,
             "how the table was chosen; 0: for this speed, 1: between two tables, 2: the next slower one"),
    Variable("alarms", Kind.INT32, Causality.OUTPUT,
             "sum of " + "; ".join(f"{bit}: {meaning.removeprefix('alarm: ')}" for _, bit, meaning in NAMED)),
    Variable("unseen", Kind.INT32, Causality.OUTPUT, "samples since a reading was believed"),
)  # fmt: skip


CATEGORY: Final = Variable("category", Kind.INT32, Causality.PARAMETER, "number of the weight category", (1,), low=1,
                           high=255)  # fmt: skip
AXLES: Final = Variable("axles", Kind.INT32, Causality.PARAMETER, "axles of the cut", (4,), low=1, high=MOST_AXLES)
COMMANDED: Final = Variable("commanded_m_s", Kind.FLOAT64, Causality.PARAMETER, "exit speed that is commanded", (0.0,),
                            "m/s", low=0.0, high=MOST_M_S)  # fmt: skip
INITIAL_STAGE: Final = Variable("initial_stage", Kind.INT32, Causality.PARAMETER,
                                "stage that is commanded when the cut comes", (0,), low=0,
                                high=MOST_STAGES - 1)  # fmt: skip


def parameters(book: TableBook) -> tuple[Variable, ...]:
    """What chooses the table; to begin with, the first of the book."""
    first = book.tables[0]
    return (
        replace(CATEGORY, start=(book.number_of(first.cut.category),)),
        replace(AXLES, start=(len(first.cut.axle_offsets_m),)),
        replace(COMMANDED, start=(float(first.target_speed_m_s),)),
        INITIAL_STAGE,
    )
