"""The document of a unit of FMI 2.0: modelDescription.xml (FMI 2.0.4, sections 2.2 and 4.3)."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final
from xml.etree.ElementTree import Element, SubElement

from synth.retarder.fmi.description import Head, add_surroundings, attributes_of, text_of, values_of
from synth.retarder.fmi.variables import Causality, Kind, Variable

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
