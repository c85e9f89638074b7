"""A reader of TwinCAT objects that shares nothing with what wrote them: it makes one Structured Text of a folder."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass
from xml.etree import ElementTree


@dataclass(frozen=True)
class TcObject:
    """What a file holds: its name and id, the declaration, and the statements, None for a structure."""

    name: str
    id: str
    declaration: str
    statements: str | None

    def text(self) -> str:
        """The object as Structured Text."""
        if self.statements is not None:
            return f"{self.declaration}\n{self.statements}\nEND_FUNCTION_BLOCK\n"
        # The evaluator wants what the standard has behind a structure, and TwinCAT leaves out.
        return re.sub(r"\bEND_STRUCT\b(?!;)", "END_STRUCT;", self.declaration)


def objects(files: Mapping[str, bytes]) -> list[TcObject]:
    """The objects of a folder, structures first; each file is called as its object is."""
    found = []
    for path, content in files.items():
        root = ElementTree.fromstring(content)
        assert root.tag == "TcPlcObject"
        (element,) = root
        name, ending = path.rpartition("/")[2].split(".")
        assert (element.tag, element.get("Name")) == ({"TcPOU": "POU", "TcDUT": "DUT"}[ending], name)
        body = element.findtext("Implementation/ST")
        assert (body is None) == (ending == "TcDUT")
        found.append(TcObject(name, str(element.get("Id")), str(element.findtext("Declaration")), body))
    return sorted(found, key=lambda each: each.statements is not None)


def structured_text(files: Mapping[str, bytes]) -> str:
    """All objects in an order in which none needs a later one: TwinCAT looks for it itself."""
    rest, text, known = objects(files), "", set[str]()
    names = {each.name for each in rest}
    while rest:
        for each in rest:
            used = set(re.findall(r"\w+", re.sub(r"\(\*.*?\*\)", "", each.declaration, flags=re.DOTALL))) & names
            if used <= known | {each.name}:
                text += each.text() + "\n"
                known.add(each.name)
                rest.remove(each)
                break
        else:
            raise AssertionError(f"{[each.name for each in rest]} need each other")
    return text
