"""What a tune for point sensors has come to: the book, what its passes say of the limits, and its files."""

from __future__ import annotations

from dataclasses import dataclass

from synth.frame.exhibits import File
from synth.retarder.acceptance import CaseVerdict
from synth.retarder.forms.table_forms import c_form, csv_form, plc_form
from synth.retarder.sensors.sensor_acceptance import judged
from synth.retarder.sensors.sensor_tune import SensorBook
from tuning_tables import InvalidTable


@dataclass(frozen=True)
class FoundPassages:
    """`verdicts`: on the cases of `book`, in its order; `files`: the tables together, in every form.

    `no_st`: why there is no Structured Text, '' where there is.
    """

    book: SensorBook
    verdicts: tuple[CaseVerdict, ...]
    files: tuple[File, ...]
    no_st: str


def found_passages(book: SensorBook) -> FoundPassages:
    """The book with its verdicts, and its tables as C99 and as Structured Text.

    More tables than 16 bits count are no Structured Text. `InvalidTable` where they make no book.
    """
    tables = [case.table for case in book.cases]
    files, no_st = {f"c/{name}": content for name, content in c_form(tables).items()}, ""
    try:
        files |= {f"st/{name}": content for name, content in plc_form("st", tables).items()}
    except InvalidTable as fault:
        no_st = str(fault)
    if book.config.output.csv:
        files |= {f"tables/{name}": content for name, content in csv_form(tables).items()}
    return FoundPassages(book, judged(book), tuple(File(*each) for each in files.items()), no_st)
