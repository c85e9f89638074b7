"""The members of a table, declared once where its value is: from a declaration follow JSON, schema, HDF5, CSV, page.

A frozen dataclass declares its members with `Annotated[type, leaf]`. A leaf (`numbers`, `texts`) tells what a number or
a text means, its limits, and how each file holds it. A member that is a declared dataclass itself is a section.
"""
