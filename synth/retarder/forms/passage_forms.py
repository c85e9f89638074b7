"""The forms that tables for point sensors are exported in: for each the files, by name, with their bytes."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from functools import partial

from synth.retarder.forms.code_options import PLAIN, PLC_NAMES, CodeOptions
from synth.retarder.forms.table_forms import Files, csv_form, json_form
from tuning_tables.passages.passage_table import PassageTable

PassageForm = Callable[[Sequence[PassageTable], CodeOptions], Files]


def passage_c_form(tables: Sequence[PassageTable], options: CodeOptions = PLAIN) -> Files:
    """C99 source of all tables together, self-test and golden rows; `InvalidTable` if they make no book."""
    from tuning_tables.passages.c_source import passage_c_files
    from tuning_tables.passages.passage_book import PassageBook

    return passage_c_files(PassageBook(tuple(tables)), options.prefix, options.self_test.passages)


def passage_plc_form(name: str, tables: Sequence[PassageTable], options: CodeOptions = PLAIN) -> Files:
    """Structured Text of all tables together and its self-test, in a form of `PLC_FORMS`.

    `InvalidTable` if they make no book.
    """
    from synth.retarder.forms.plc_forms import PLC_FORMS
    from tuning_tables.passages.passage_book import PassageBook
    from tuning_tables.passages.st_source import passage_export

    export = passage_export(PassageBook(tuple(tables)), options.prefix, options.self_test.passages)
    return PLC_FORMS[name].files(export, options)


PASSAGE_FORMS: Mapping[str, PassageForm] = {
    "json": json_form,
    "csv": csv_form,
    "c": passage_c_form,
    **{name: partial(passage_plc_form, name) for name in PLC_NAMES},
}
