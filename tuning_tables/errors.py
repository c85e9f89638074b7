"""Why a table was refused.

Each class is one answer to "what do I do now?": correct the values, export again, take another file, or take another
version of the tool. Every message is one sentence that names the file, the key, the value and what is allowed.
"""


class TableError(ValueError):
    """A controller table, or a file that should hold one, was refused."""


class InvalidTable(TableError):
    """The values handed over make no table that a controller may run: correct them where they are computed."""


class DamagedTable(TableError):
    """The file is not what was exported (cut off, changed, incomplete, of another shape): export it again."""


class UnknownFormat(TableError):
    """The file is sound in its own right, but it is not a table or book of this project."""


class OtherKind(TableError):
    """The file is sound, but its table is of another kind than is needed here: give another."""


class NewerVersion(TableError):
    """The file was written to a later version of the format than this reader knows: update the reader."""


class IllegalName(ValueError):
    """A name of the export is none that a tool takes: choose another prefix."""


class InvalidLog(ValueError):
    """A file of measured passes, or its mapping, cannot be used: correct the file, the mapping, or leave it out."""
