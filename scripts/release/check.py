"""All steps of `scripts/release_check`, one after the other; what they make is left in `dist`."""

from __future__ import annotations

import sys
import tempfile
from collections.abc import Iterator
from functools import partial
from pathlib import Path
from typing import Final

from scripts.release.bare import constraints, pythons, used
from scripts.release.bill import billed
from scripts.release.built import built_twice, found_in
from scripts.release.step import Step
from scripts.release.tree import clean, lock_fits, one_version

ROOT: Final = Path(__file__).parents[2]
INTO: Final = ROOT / "dist"


def main(named: list[str]) -> int:
    """Run all steps with the interpreters `named`, or with all that are found; 1 if one failed."""
    there, absent = pythons(named)
    if not there:
        sys.exit(f"release_check: none of {', '.join(absent)} starts here")
    with tempfile.TemporaryDirectory(prefix="retarder-synth-release-") as folder:
        held = [step.told() for step in before(Path(folder))]
        if held[-1]:  # there is a wheel
            held += [step.told() for step in after(Path(folder), there)]
    print(f"not checked: {', '.join(absent)} (not there)" if absent else "every supported Python was checked")
    print("a release" if all(held) else "no release: see what FAILED")
    return 0 if all(held) else 1


def before(work: Path) -> Iterator[Step]:
    """What the checkout and the build must be."""
    yield Step("tree", partial(clean, ROOT))
    yield Step("version", partial(one_version, ROOT))
    yield Step("lock", partial(lock_fits, ROOT))
    yield Step("build", partial(built_twice, ROOT, work, INTO))


def after(work: Path, there: list[str]) -> Iterator[Step]:
    """What the wheel must do, and what it brings."""
    wheel, limits = found_in(work / "dist-0").wheel, constraints(ROOT, work)
    for python in there:
        yield Step(Path(python).name, partial(used, python, wheel, limits, work / Path(python).name))
    bare = work / Path(there[0]).name / "bare"
    yield Step("bill", partial(billed, ROOT, there[0], bare, work, INTO))


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
