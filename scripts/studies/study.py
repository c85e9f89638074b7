"""A study: a question, how long the answer takes, options, and the run that answers it.

What can be listed is light; what runs is in a module of its own, which is imported when the study runs or is read. That
module calls its `Method` METHOD.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from importlib import import_module
from typing import TYPE_CHECKING, Any, Generic, TypeVar

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from scripts.studies.markdown_table import MarkdownTable

Tell = Callable[[str], None]
"""Is called with a sentence whenever a part of a study is done; any thread may call it."""


def silent(_: str) -> None:
    """Tell nobody."""


class Findings(ABC):
    """What a study has found: a frozen dataclass of plain values (numbers, text, tuples, dicts, such dataclasses).

    Its JSON form holds all of it, and it is read back from there; so tables and figures follow from values alone.
    Numbers are finite; None stands for what there is not.
    """

    @abstractmethod
    def tables(self) -> Mapping[str, MarkdownTable]:
        """The tables by name; a document shows one between <!-- study STUDY NAME --> and <!-- end -->."""

    def sentences(self) -> tuple[str, ...]:
        """What is told besides the tables."""
        return ()

    def faults(self) -> tuple[str, ...]:
        """A sentence for every claim that the study was to check and that does not hold."""
        return ()


_Options = TypeVar("_Options")
_Findings = TypeVar("_Findings", bound=Findings)


@dataclass(frozen=True)
class Method(Generic[_Options, _Findings]):
    """How a study is done.

    `options`: frozen dataclass of all options with their defaults, which are those of the documentation; `smallest`:
    options with which it runs in seconds, through every step; `findings`: the type of what `run` returns.
    """

    options: type[_Options]
    smallest: _Options
    findings: type[_Findings]
    run: Callable[[_Options, Tell], _Findings]


@dataclass(frozen=True)
class Study:
    """Name, the question that it answers (one sentence), seconds on two cores, page of docs/, module.

    `pictures`: the module whose `figures` draws the findings, '' where nothing is drawn; what draws is loaded then.
    """

    name: str
    question: str
    seconds: float
    page: str
    module: str
    pictures: str = ""

    @property
    def method(self) -> Method[Any, Findings]:
        """How it is done; imports its module."""
        found = import_module(self.module).METHOD
        assert isinstance(found, Method)
        return found

    def figures(self, findings: Findings) -> Mapping[str, Figure]:
        """Pictures by name, in the house style; a page shows each."""
        if not self.pictures:
            return {}
        drawn: Mapping[str, Figure] = import_module(self.pictures).figures(findings)
        return drawn

    @property
    def duration(self) -> str:
        """'40 s' or '12 min'."""
        return f"{self.seconds:.0f} s" if self.seconds < 100.0 else f"{self.seconds / 60.0:.0f} min"
