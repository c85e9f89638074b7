"""The checker of `verify` and the library python-control on the small books, and faults that they must find."""

from __future__ import annotations

import re
import shutil
from collections.abc import Iterator, Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any, Final

from synth.cli.qualification.check import Check, Ran, checked, not_checked, program
from synth.cli.qualification.tuned import Tuned
from synth.frame.printed_numbers import counted
from tuning_tables import from_json, to_json

PASSES: Final = 2000
VERIFY: Final = f"retarder-synth verify, which shares no code, {PASSES} coarse passes of its own"
PLANTED: Final = "nothing is found without the fault, and the fault is found"
FINDINGS: Final = (1, 3)
"""Exit codes of `verify`: a claim is not confirmed; a file is damaged or disagrees."""

CODE: Final = "c/retarder_table.c"
NUMBER: Final = re.compile(r"(0x1\.)([0-9a-e])(?=[0-9a-f]*p)")
"""A number of C that has a digit which can be one more."""


def prediction_check(book: Tuned) -> Check:
    """Whether the exact prediction agrees with the simulator."""
    what = "Prediction against the second simulator"
    how = "density of exit speeds on a grid, against passes in time; no clock, noise or integral is shared"
    if not book.tables:
        return not_checked(what, how, "the tune failed", "predicted / simulated rms")
    limits = book.summary["config"]["acceptance"]
    low, high = limits["prediction_ratio_low"], limits["prediction_ratio_high"]
    limit = f"predicted / simulated rms from {low:g} to {high:g}"
    predicted, simulated = book.document["predicted"]["rms_m_s"], book.document["validated"]
    rms, (least, most) = simulated["rms_m_s"], simulated["rms_ci95_m_s"]
    ratio = predicted / rms
    found = (
        f"{predicted:.4f} m/s predicted, {rms:.4f} [{least:.4f}, {most:.4f}] m/s in {simulated['passes']} passes; "
        f"ratio {ratio:.3f} [{predicted / most:.3f}, {predicted / least:.3f}]"
    )
    return checked(what, how, found, limit, low <= ratio <= high)


def verify_check(book: Tuned) -> Check:
    """Whether the independent checker confirms tables, exports and claims."""
    what, limit = f"Second program, {book.kind} speed", "nothing found"
    if not book.tables:
        return not_checked(what, VERIFY, "the tune failed", limit)
    ran = program(f"verify {book.folder.name} --passes {PASSES} --json", book.folder.parent)
    return checked(what, VERIFY, verified(ran), limit, ran.code == 0)


def verified(ran: Ran) -> str:
    """What `verify` says, in words."""
    document: Mapping[str, Any] | None = ran.document
    if document is None:
        return ran.sentence
    figures = [simulated(each) for each in document["tables"]]
    return "; ".join([counted(len(document["files"]), "file"), *figures, findings(document)])


def findings(document: Mapping[str, Any]) -> str:
    """What `verify` found, in words."""
    return "; ".join(finding["sentence"] for finding in document["findings"]) or "nothing found"


def simulated(table: Mapping[str, Any]) -> str:
    """What the coarse passes of one table gave, in words."""
    found = table["simulated"]
    if found is None:
        return f"not simulated: {table['skipped']}"
    low, high = found["rms_ci95_m_s"]
    return (
        f"rms {found['rms_m_s']:.4f} [{low:.4f}, {high:.4f}] m/s in {found['passes']} passes, "
        f"{table['predicted_rms_m_s']:.4f} predicted"
    )


def planted_checks(book: Tuned) -> Iterator[Check]:
    """Whether the checker finds a claim that is not true, and code that is not that of the tables."""
    name, table = next(iter(book.tables.items()), ("", b""))
    claim, code = "Second program: finds a false claim", "Second program: finds a changed number in the C code"
    if not table:
        for what in (claim, code):
            yield not_checked(what, VERIFY, "the tune failed", PLANTED)
        return
    yield planted(claim, "half of the predicted rms is stated, with a right checksum", book, {name: halved(table)})
    changed = {CODE: with_other_number(book.content[CODE])}
    yield planted(code, "one digit of one coefficient is one more", book, changed)


def planted(what: str, how: str, book: Tuned, changed: Mapping[str, bytes]) -> Check:
    """Whether `verify` finds what was `changed` in the book, and nothing where it was not.

    The summary is left out: it has the hashes of all files, by which every change would be found.
    """
    sound = {name: content for name, content in book.content.items() if name.startswith(("tables/", "c/"))}
    before, after = (verify_files(files, book.folder.with_name("planted")) for files in (sound, {**sound, **changed}))
    told = (findings(ran.document) if ran.document else ran.sentence for ran in (before, after))
    found = ". With it: ".join(told)
    return checked(what, how, f"without the fault: {found}", PLANTED, before.code == 0 and after.code in FINDINGS)


def verify_files(files: Mapping[str, bytes], folder: Path) -> Ran:
    """What `verify` says of `files` in `folder`, which is made and removed."""
    for name, content in files.items():
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        (folder / name).write_bytes(content)
    ran = program(f"verify {folder.name} --json", folder.parent)
    shutil.rmtree(folder)
    return ran


def halved(content: bytes) -> bytes:
    """A table that predicts half of its rms."""
    table = from_json(content)
    return to_json(replace(table, predicted=replace(table.predicted, rms_m_s=0.5 * table.predicted.rms_m_s)))


def with_other_number(code: bytes) -> bytes:
    """C code in which the first coefficient that has a fraction is another number."""
    head, mark, rest = code.decode("ascii").partition("/* coefficient */")
    return (head + mark + NUMBER.sub(lambda found: found[1] + f"{int(found[2], 16) + 1:x}", rest, count=1)).encode()


def loop_check(book: Tuned) -> Check:
    """Whether a nominal pass is the same to the simulator and to python-control."""
    what = f"Simulator, {book.kind} speed: against python-control"
    how, limit = "retarder-synth loop: a nominal pass by two integrations", "exit code 0: the two agree"
    if not book.tables:
        return not_checked(what, how, "the tune failed", limit)
    ran = program(f"loop {book.folder.name} -o {book.kind}-loop --json", book.folder.parent)
    loops = ran.document["tables"]["loops"] if ran.document else []
    said = "; ".join(
        f"{each['python_control_m_s']:.4f} and {each['simulator_m_s']:.4f} m/s at the exit, at most "
        f"{each['difference_mm_s']:.3f} mm/s apart"
        for each in loops
    )
    return checked(what, how, said or ran.sentence, limit, ran.code == 0)
