"""What a run of a study leaves: JSON, Markdown and pictures, all of the same values."""

from __future__ import annotations

import json
import re
from collections.abc import Mapping
from dataclasses import asdict, dataclass
from importlib.metadata import version
from pathlib import Path
from typing import TYPE_CHECKING, Any

from scripts.studies.study import Findings, Study, Tell, silent
from synth.frame.faults import InputError

if TYPE_CHECKING:
    from matplotlib.figure import Figure

FORMAT, VERSION = "retarder-study", 1

_LIST_OF_SCALARS = re.compile(r"\[\n\s+([^\[\]{}]*?)\n\s+\]")
_NEXT_ITEM = re.compile(r",\n\s+")


@dataclass(frozen=True)
class Result:
    """A study, the version of the software that ran it, its options, and what it has found."""

    study: Study
    software: str
    options: Any
    findings: Findings

    def json(self) -> str:
        """The whole result; the same result gives the same text. `ValueError` for a number that is not finite."""
        document = {
            "format": FORMAT,
            "version": VERSION,
            "study": self.study.name,
            "software": self.software,
            "options": plain(asdict(self.options)),
            "findings": plain(asdict(self.findings)),  # type: ignore[call-overload]  # a dataclass, by contract
        }
        text = json.dumps(document, indent=1, ensure_ascii=False, allow_nan=False)
        return _LIST_OF_SCALARS.sub(in_one_line, text) + "\n"

    def markdown(self) -> str:
        """All tables with their titles, and what is told besides."""
        parts = [f"# {self.study.name}\n\n{self.study.question}\n"]
        parts += [f"**{each.title}**\n\n{each.markdown()}" for each in self.findings.tables().values()]
        parts += ["".join(f"- {sentence}\n" for sentence in (*self.findings.sentences(), *self.findings.faults()))]
        return "\n".join(part for part in parts if part)

    def figures(self) -> Mapping[str, Figure]:
        """The pictures by the name of their file, without suffix."""
        name = self.study.name
        return {f"{name}-{key}": figure for key, figure in self.study.figures(self.findings).items()}


def run_study(study: Study, options: Any = None, tell: Tell = silent) -> Result:
    """The result with `options` (the defaults for None). Raises `InputError` for options that make no sense."""
    from synth.solver.descent import one_blas_thread

    method = study.method
    chosen = method.options() if options is None else options
    with one_blas_thread():  # with two the polish ends in other last bits
        return Result(study, version("retarder-synth"), chosen, method.run(chosen, tell))


def read_result(study: Study, path: Path) -> Result:
    """The result of `study` in the file `path`. Raises `InputError` for a file that no run of it has left."""
    from pydantic import TypeAdapter, ValidationError

    try:
        text = path.read_text(encoding="utf-8")
    except FileNotFoundError:
        raise InputError(f"{path}: there is no such file; 'retarder-synth study {study.name}' makes it") from None
    again = f"run 'retarder-synth study {study.name}' again"
    try:
        document = json.loads(text)
        known = (document["format"], document["version"], document["study"]) == (FORMAT, VERSION, study.name)
        if not known:
            raise InputError(f"{path}: this is no result of the study {study.name}; {again}")
        method = study.method
        options = TypeAdapter(method.options).validate_python(document["options"])
        findings = TypeAdapter(method.findings).validate_python(document["findings"])
    except (json.JSONDecodeError, KeyError, TypeError, ValidationError) as fault:
        raise InputError(
            f"{path}: what it holds is not what the study finds now ({first_line(fault)}); {again}"
        ) from None
    result = Result(study, document["software"], options, findings)
    if json.loads(result.json()) != document:
        raise InputError(f"{path}: it holds more than the study finds now; {again}")
    return result


def plain(value: Any) -> Any:
    """`value` of dict, list, tuple, numbers and text as JSON holds it."""
    if isinstance(value, Mapping):
        return {str(key): plain(each) for key, each in value.items()}
    if isinstance(value, list | tuple):
        return [plain(each) for each in value]
    return str(value) if isinstance(value, Path) else value


def in_one_line(found: re.Match[str]) -> str:
    """A list of numbers or words without line ends."""
    return f"[{_NEXT_ITEM.sub(', ', found[1])}]"


def first_line(fault: Exception) -> str:
    """The fault in one line."""
    lines = [line.strip() for line in str(fault).splitlines() if line.strip()]
    return ": ".join(lines[1:3]) if len(lines) > 2 else (lines[0] if lines else type(fault).__name__)
