"""Each requirement has a test and each marked test a requirement; the matrix of a run tells what became of them."""

from __future__ import annotations

import re
import subprocess
import sys
from pathlib import Path

import pytest

from scripts.documentation import requirements as requirements_module
from scripts.documentation.requirements import MARK, ROOT, Proof, proofs, requirements, with_proofs


def test_each_requirement_has_a_test_in_each_check_and_each_marked_test_a_requirement() -> None:
    found, stated = list(proofs()), requirements()
    assert 60 <= len(stated) <= 100
    assert [name for name, sentence in stated.items() if " shall " not in sentence] == []
    assert [
        name for name in stated if name not in {name for each in found if not each.is_long for name in each.ids}
    ] == []
    assert [each for each in found if not each.ids or set(each.ids) - stated.keys()] == []


def test_the_safety_pages_cite_what_there_is() -> None:
    manual, *others = (ROOT / "docs" / "reference" / f"safety-{name}.md" for name in ("manual", "failures", "assessor"))
    duties = re.findall(r"^- \*\*(DUTY-\d\d)\*\* ", manual.read_text(encoding="utf-8"), re.MULTILINE)
    assert len(duties) == len(set(duties))
    cited = {name for page in others for name in re.findall(r"[A-Z]+-\d\d\b", page.read_text(encoding="utf-8"))}
    assert len(cited) > 40
    assert cited - set(duties) - requirements().keys() == set()
    assert set(duties) - cited == {"DUTY-05", "DUTY-13"}  # about code of one's own, and every change


def test_a_mark_that_is_not_above_a_test_is_told(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "tests").mkdir()
    monkeypatch.setattr(requirements_module, "ROOT", tmp_path)
    mark = f'@{MARK}("RULE-01")\n'
    (tmp_path / "tests" / "test_a.py").write_text(f"{mark}def test_it():\n    pass\n", encoding="utf-8")
    assert list(proofs()) == [Proof("tests/test_a.py", "test_it", ("RULE-01",), False)]
    (tmp_path / "tests" / "test_b.py").write_text(
        f"class All:\n    {mark}    def test_it():\n        pass\n", encoding="utf-8"
    )
    with pytest.raises(ValueError, match=r"tests/test_b\.py: a mark of a requirement stands elsewhere"):
        list(proofs())


def test_the_page_names_each_test_below_its_requirement() -> None:
    name, sentence = next(iter(requirements().items()))
    shown = with_proofs(f"- **{name}** {sentence}\n\nMore.\n").splitlines()
    assert shown[0] == f"- **{name}** {sentence}"
    assert shown[1:-2] == [
        f"  - `{each.file}`: {each.test.removeprefix('test_').replace('_', ' ')}"
        for each in proofs()
        if name in each.ids
    ]


@pytest.mark.parametrize("processes", [0, 2])
def test_a_run_writes_what_became_of_each_requirement(processes: int, tmp_path: Path) -> None:
    """Of some tests as they are, in this process and in others; a test is told once, however many cases it has."""
    ran = subprocess.run(
        [sys.executable, "-m", "pytest", "-q", "-p", "no:cacheprovider", "-n", str(processes), "--matrix",
         tmp_path / "m.md", "tests/tuning_tables/test_surfaces.py", "tests/tuning_tables/test_canonical.py"],
        cwd=ROOT, capture_output=True, text=True, check=False,
    )  # fmt: skip
    assert ran.returncode == 0, ran.stdout
    told = (tmp_path / "m.md").read_text(encoding="utf-8").splitlines()
    assert f"{len(requirements())} requirements: {len(requirements()) - 4} not run, 4 passed." in told
    test = "`tests/tuning_tables/test_surfaces.py::test_a_stage_that_there_is_not_holds`"
    assert f"| RULE-02 | passed | {test} | 4 | 0 | 0 |" in told
    assert len(told) > 6 + sum(len(each.ids) for each in proofs())
    assert {line.split(" | ")[1] for line in told if line.startswith("| RULE-01 |")} == {"not run"}
