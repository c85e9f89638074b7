"""The versions of the Functional Mock-up Interface that a unit is made for: what differs between them."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Final, TypeAlias

from synth.retarder.fmi.description import Head, build_description, model_description, model_description_2
from synth.retarder.fmi.variables import Variable, scalars
from synth.retarder.forms.code_options import FMU_NAMES

Documents: TypeAlias = Mapping[str, bytes]
"""Documents of a unit by their paths in it."""


@dataclass(frozen=True)
class Interface:
    """`c`: its files of C; `listed`: the variables that have a value reference each, which is their place.

    `documents`: of the head of a unit, these variables and the names of the files to compile. `folders`: of libraries,
    by platform.
    """

    c: tuple[str, ...]
    listed: Callable[[Sequence[Variable]], tuple[Variable, ...]]
    documents: Callable[[Head, Sequence[Variable], Sequence[str]], Documents]
    folders: Mapping[str, str]


def documents_3(head: Head, variables: Sequence[Variable], sources: Sequence[str]) -> Documents:
    """Of FMI 3.0."""
    return {
        "modelDescription.xml": model_description(head, variables),
        "sources/buildDescription.xml": build_description(head, sources),
    }


def documents_2(head: Head, variables: Sequence[Variable], sources: Sequence[str]) -> Documents:
    """Of FMI 2.0."""
    return {"modelDescription.xml": model_description_2(head, variables, sources)}


FMI_3: Final = Interface(
    ("fmi3.h", "unit.h", "interface.c", "not_offered.c"),
    tuple,
    documents_3,
    {name: name for name in ("x86_64-linux", "aarch64-linux")},
)
FMI_2: Final = Interface(
    ("fmi3.h", "unit.h", "interface.c", "fmi2.h", "fmi2.c"), scalars, documents_2, {"x86_64-linux": "linux64"}
)
INTERFACES: Final[Mapping[str, Interface]] = dict(zip(FMU_NAMES, (FMI_3, FMI_2), strict=True))
"""By the name of the form that tables are exported in."""
