"""What a run found of each requirement: `pytest --matrix FILE` writes requirement, tests and outcomes as Markdown."""

from __future__ import annotations

import platform
import subprocess
from collections import Counter
from collections.abc import Iterator
from importlib.metadata import version
from pathlib import Path

import pytest

from scripts.documentation.requirements import ROOT, proofs, requirements
from tests.effort import IS_LONG

MARK = "requirement"


class RequirementMatrix:
    """The plugin of a run that keeps outcomes; tests that other processes run tell their ids as properties."""

    def __init__(self, path: Path) -> None:
        if path.is_dir():
            raise pytest.UsageError(f"--matrix {path}: this is a directory; name a file")
        path.parent.mkdir(parents=True, exist_ok=True)
        self.path = path
        self.outcomes: dict[str, dict[str, Counter[str]]] = {name: {} for name in requirements()}
        for proof in proofs():
            for name in proof.ids:
                self.outcomes[name][f"{proof.file}::{proof.test}"] = Counter()

    def pytest_collection_modifyitems(self, items: list[pytest.Item]) -> None:
        """Have each report of a marked test tell its ids."""
        for item in items:
            item.user_properties += [(MARK, name) for mark in item.iter_markers(MARK) for name in mark.args]

    def pytest_runtest_logreport(self, report: pytest.TestReport) -> None:
        """Count what a test came to; a part that passed before or after it counts only where it did not pass."""
        if report.when == "call" or not report.passed:
            test = report.nodeid.partition("[")[0]
            for name in (value for key, value in report.user_properties if key == MARK):
                self.outcomes[str(name)][test][report.outcome] += 1

    def pytest_sessionfinish(self, session: pytest.Session) -> None:
        """Write the matrix, in the process that hears of all tests."""
        if not hasattr(session.config, "workerinput"):
            self.path.write_text("\n".join(self.lines()) + "\n", encoding="utf-8")

    def lines(self) -> Iterator[str]:
        """The matrix: what was tested, what it comes to, then a row for each test of each requirement."""
        verdicts = {name: verdict(found) for name, found in self.outcomes.items()}
        counted = Counter(verdicts.values())
        yield "# Requirements, tests, results\n"
        yield (
            f"retarder-synth {version('retarder-synth')}, commit {commit()}; Python {platform.python_version()}, "
            f"{platform.platform()}; tests at their {'full' if IS_LONG else 'short'} size.\n"
        )
        yield f"{len(verdicts)} requirements: {', '.join(f'{n} {word}' for word, n in sorted(counted.items()))}.\n"
        yield "| requirement | | test | passed | failed | skipped |\n|---|---|---|---|---|---|"
        for name, found in self.outcomes.items():
            for test, counts in found.items():
                cells = " | ".join(str(counts[outcome]) for outcome in ("passed", "failed", "skipped"))
                yield f"| {name} | {verdicts[name]} | `{test}` | {cells} |"


def verdict(found: dict[str, Counter[str]]) -> str:
    """Passed: tests did and none failed; not run: none came to an end."""
    total = sum(found.values(), Counter[str]())
    return "failed" if total["failed"] else "passed" if total["passed"] else "not run"


def commit() -> str:
    """What is checked out, and whether it was changed."""
    asked = ["git", "describe", "--always", "--dirty", "--abbrev=40", "--exclude=*"]
    told = subprocess.run(asked, cwd=ROOT, capture_output=True, text=True, check=False)
    return told.stdout.strip() or "unknown"
