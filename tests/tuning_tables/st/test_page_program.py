"""The program on the page of Structured Text goes over to other tables as Python does where the weight is wrong."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest

from tests.controller_code.weighed_cuts import SAMPLES, TARGET_M_S, braked_by, weighed_book, weighed_cuts
from tests.st_files import st_files
from tests.tuning_tables.st.evaluator import Program
from tuning_tables.st_source import TABLE_FILE

PAGE = Path(__file__).parents[3] / "docs" / "reference" / "structured-text.md"
CUTS = 300
CATEGORIES = range(1, 6)
HEAD = """
FUNCTION_BLOCK PAGE_PROGRAM
VAR_INPUT Begins : BOOL; Told : INT; CutAxles : INT; Command_m_s : REAL;
    FirstAxle : REAL; Radar : REAL; MeanOver : REAL; END_VAR
VAR_OUTPUT Present : INT; Speeds : ARRAY[1..5] OF REAL; There : ARRAY[1..5] OF BOOL; END_VAR
VAR After : INT; Raised : INT; Select : RETARDER_SELECT; NewCut : RETARDER_BEGIN; Observe : RETARDER_OBSERVE;
    Alarms : RETARDER_ALARMS;
"""


def unrolled(loop: re.Match[str]) -> str:
    """A loop over the categories as one text after the other: the evaluator has no arrays of records."""
    texts = (re.sub(r"\bEach\b", str(each), loop[1]) for each in CATEGORIES)
    return re.sub(r"\b(Tables|Cuts)\[(\d)\]", r"\1_\2", "".join(texts))


def block_of_the_page() -> str:
    """The page's program but for the decision, as a block."""
    blocks = re.findall(r"```\n(.*?)```", PAGE.read_text("utf-8"), re.S)
    (text,) = (each for each in blocks if "There[Each]" in each)
    text = re.sub(r"FOR Each := 1 TO 5 DO\n(.*?)END_FOR;", unrolled, text, flags=re.S)
    once, at_every_sample, _ = re.split(r"\(\* at every [^*]*\*\)", text)
    own = "".join(f"    Tables_{each} : RETARDER_TABLE; Cuts_{each} : RETARDER_ESTIMATE;\n" for each in CATEGORIES)
    return f"{HEAD}{own}END_VAR\nIF Begins THEN\n{once}END_IF;\n{at_every_sample}END_FUNCTION_BLOCK\n"


@pytest.mark.long
def test_the_page_goes_over_to_the_tables_that_python_does() -> None:
    book, cuts = weighed_book(), list(weighed_cuts(CUTS))
    program = Program(st_files(book)[TABLE_FILE] + block_of_the_page().encode("ascii"))
    instance = program.new("PAGE_PROGRAM")
    told, samples = np.array([each for each, _ in cuts]), np.array([each for _, each in cuts])
    expected = [list(braked_by(book, *cut)) for cut in cuts]
    for now in range(SAMPLES):
        s_m, v_m_s, kpa = samples[:, now].T
        program.call(
            "PAGE_PROGRAM", instance, Begins=now == 0, Told=told, CutAxles=4, Command_m_s=np.float32(TARGET_M_S),
            FirstAxle=s_m, Radar=v_m_s, MeanOver=kpa,
        )  # fmt: skip
        numbers, speeds = np.array([each[now] for each in expected]).T
        present = instance["PRESENT"].value
        assert np.array_equal(present, numbers)
        assert np.array_equal(instance["SPEEDS"].load(present, None), speeds.astype(np.float32))
    assert 100 < np.count_nonzero(present != told) < 250
