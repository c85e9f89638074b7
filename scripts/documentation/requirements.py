"""The requirements on their page, and the tests that bear their ids: read as text, as collecting tests takes long."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator
from pathlib import Path
from typing import Final, NamedTuple

ROOT: Final = Path(__file__).parents[2]
PAGE: Final = "reference/requirements"
STATED: Final = re.compile(r"^- \*\*([A-Z]+-\d\d)\*\* ((?:.+\n)(?:  .+\n)*)", re.MULTILINE)
"""A requirement on the page, which may go on in indented lines."""
MARK: Final = "pytest.mark.requirement"
"""What marks a test."""


class Proof(NamedTuple):
    """A test, and the requirements that it proves; `is_long`: it runs with `scripts/test --long` alone."""

    file: str
    test: str
    ids: tuple[str, ...]
    is_long: bool


def requirements() -> dict[str, str]:
    """The sentence of each id, in the order of the page; `ValueError` for an id that is given twice."""
    stated = STATED.findall((ROOT / "docs" / f"{PAGE}.md").read_text(encoding="utf-8"))
    found = {name: " ".join(sentence.split()) for name, sentence in stated}
    if len(found) < len(stated):
        raise ValueError(f"{PAGE}.md: an id is given twice")
    return found


def proofs() -> Iterator[Proof]:
    """All marked tests in the order of their files; `ValueError` for a mark that stands elsewhere than above a test."""
    for path in sorted((ROOT / "tests").rglob("test_*.py")):
        text = path.read_text(encoding="utf-8")
        if MARK in text:
            file = path.relative_to(ROOT).as_posix()
            found = list(marked(file, ast.parse(text)))
            if len(found) != text.count(f"@{MARK}("):
                raise ValueError(f"{file}: a mark of a requirement stands elsewhere than once above a test")
            yield from found


def marked(file: str, module: ast.Module) -> Iterator[Proof]:
    """The tests of a module that bear ids."""
    for test in module.body:
        if isinstance(test, ast.FunctionDef):
            names = [ast.unparse(each) for each in test.decorator_list]
            for each in test.decorator_list:
                if isinstance(each, ast.Call) and ast.unparse(each.func) == MARK:
                    yield Proof(file, test.name, tuple(map(ast.literal_eval, each.args)), "pytest.mark.long" in names)


def with_proofs(page: str) -> str:
    """The text of the page with the tests below each requirement."""
    of: dict[str, list[Proof]] = {name: [] for name in requirements()}
    for proof in proofs():
        for name in proof.ids:
            of[name].append(proof)

    def shown(stated: re.Match[str]) -> str:
        tests = (f"  - `{each.file}`: {each.test.removeprefix('test_').replace('_', ' ')}\n" for each in of[stated[1]])
        return stated[0] + "".join(tests)

    return STATED.sub(shown, page)
