"""The versions of the Functional Mock-up Interface that a unit is made for, and its documents in each of them:
modelDescription.xml (FMI 3.0.1, section 2.4; FMI 2.0.4, sections 2.2 and 4.3), and of FMI 3.0 buildDescription.xml
(section 2.5).
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Final, TypeAlias
from xml.etree import ElementTree
from xml.etree.ElementTree import Element, SubElement

from synth.retarder.fmi.variables import UNITS, Causality, Kind, Variable, scalars, shown
from synth.retarder.forms.code_options import FMU_NAMES

VERSION: Final = "3.0"
NAME: Final = {"fmiVersion": VERSION}


@dataclass(frozen=True)
class Head:
    """What a unit says of itself.

    `identifier`: a name in C; `token`: of this unit alone; `period_s`: length of a step, 0 where a step may have any.
    """

    identifier: str
    name: str
    meaning: str
    tool: str
    token: str
    period_s: float


def model_description(head: Head, variables: Sequence[Variable]) -> bytes:
    """The text of modelDescription.xml."""
    root = Element(
        "fmiModelDescription",
        {
            **NAME,
            "modelName": head.name,
            "instantiationToken": head.token,
            "description": head.meaning,
            "generationTool": head.tool,
        },
    )
    SubElement(
        root,
        "CoSimulation",
        {
            "modelIdentifier": head.identifier,
            "canGetAndSetFMUState": "true",
            "canHandleVariableCommunicationStepSize": "false" if head.period_s else "true",
            **({"fixedInternalStepSize": shown(head.period_s)} if head.period_s else {}),
        },
    )
    add_surroundings(root, head, variables)
    listed = SubElement(root, "ModelVariables")
    for reference, variable in enumerate(variables):
        add_variable(listed, reference, variable)
    structure = SubElement(root, "ModelStructure")
    for name in ("Output", "InitialUnknown"):
        for reference, variable in enumerate(variables):
            if variable.causality is Causality.OUTPUT:
                SubElement(structure, name, valueReference=str(reference))
    return text_of(root)


def add_surroundings(root: Element, head: Head, variables: Sequence[Variable]) -> None:
    """Units, log categories and the step of an experiment: the same in FMI 2.0 and 3.0."""
    units = SubElement(root, "UnitDefinitions")
    used = {each.unit for each in variables}
    for name, base in UNITS.items():
        if name in used:
            SubElement(SubElement(units, "Unit", name=name), "BaseUnit", base)
    category = {"name": "logStatusError", "description": "Why a call was refused"}
    SubElement(SubElement(root, "LogCategories"), "Category", category)
    if head.period_s:
        SubElement(root, "DefaultExperiment", startTime="0.0", stepSize=shown(head.period_s))


def add_variable(listed: Element, reference: int, variable: Variable) -> None:
    """The element of a variable."""
    attributes = attributes_of(variable, reference) | values_of(variable)
    element = SubElement(listed, variable.kind.element, attributes)
    if variable.is_array:
        SubElement(element, "Dimension", start=str(len(variable.start)))


def attributes_of(variable: Variable, reference: int) -> dict[str, str]:
    """What a variable is; outputs are calculated."""
    is_fixed = variable.causality is Causality.PARAMETER
    attributes = {
        "name": variable.name,
        "valueReference": str(reference),
        "description": variable.meaning,
        "causality": variable.causality.value,
        "variability": "fixed" if is_fixed else variable.kind.variability,
    }
    return attributes | ({"initial": "calculated"} if variable.causality is Causality.OUTPUT else {})


def values_of(variable: Variable) -> dict[str, str]:
    """Unit, limits and start of its values; what is calculated has no start."""
    attributes = {} if variable.unit is None else {"unit": variable.unit}
    if variable.causality in (Causality.PARAMETER, Causality.INPUT):
        limits = {"min": variable.low, "max": variable.high}
        whole = variable.kind is Kind.INT32
        attributes |= {key: shown(int(x) if whole else float(x)) for key, x in limits.items() if x is not None}
        attributes["start"] = " ".join(map(shown, variable.start))
    return attributes


def build_description(head: Head, sources: Sequence[str]) -> bytes:
    """The text of buildDescription.xml: C99, with the library of mathematics."""
    root = Element("fmiBuildDescription", NAME)
    build = SubElement(root, "BuildConfiguration", modelIdentifier=head.identifier, description=head.meaning)
    files = SubElement(build, "SourceFileSet", language="C99")
    for name in sources:
        SubElement(files, "SourceFile", name=name)
    SubElement(build, "Library", name="m")
    return text_of(root)


def text_of(root: Element) -> bytes:
    """A document, indented, in UTF-8."""
    ElementTree.indent(root)
    text: str = ElementTree.tostring(root, encoding="unicode")
    return f'<?xml version="1.0" encoding="UTF-8"?>\n{text}\n'.encode()


TYPES: Final = {Kind.FLOAT64: "Real", Kind.INT32: "Integer", Kind.BOOLEAN: "Boolean"}


def model_description_2(head: Head, variables: Sequence[Variable], sources: Sequence[str]) -> bytes:
    """The text of modelDescription.xml; each of `variables` has one value."""
    root = Element(
        "fmiModelDescription",
        {
            "fmiVersion": "2.0",
            "modelName": head.name,
            "guid": head.token,
            "description": head.meaning,
            "generationTool": head.tool,
            "variableNamingConvention": "structured",
        },
    )
    can_vary = "false" if head.period_s else "true"
    simulation = SubElement(
        root, "CoSimulation", modelIdentifier=head.identifier, canHandleVariableCommunicationStepSize=can_vary
    )
    files = SubElement(simulation, "SourceFiles")
    for name in sources:
        SubElement(files, "File", name=name)
    add_surroundings(root, head, variables)
    listed = SubElement(root, "ModelVariables")
    for reference, variable in enumerate(variables):
        scalar = SubElement(listed, "ScalarVariable", attributes_of(variable, reference))
        SubElement(scalar, TYPES[variable.kind], values_of(variable))
    structure = SubElement(root, "ModelStructure")
    for name in ("Outputs", "InitialUnknowns"):
        unknowns = SubElement(structure, name)
        for index, variable in enumerate(variables, 1):
            if variable.causality is Causality.OUTPUT:
                SubElement(unknowns, "Unknown", index=str(index))
    return text_of(root)


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
