"""stdout and stderr as they may be: closed, full, without a reader, or of letters that they do not know."""

from __future__ import annotations

import contextlib
import io
import os
import sys
from collections.abc import Iterator
from typing import Any, TextIO


class ReaderLeftError(Exception):
    """Nobody reads the pipe that stdout is. No `OSError`: click and rich would end the process with 1 on their own."""


class NamedStream:
    """A text stream whose faults name it: the system's own name no file."""

    def __init__(self, stream: TextIO, name: str) -> None:
        self._stream, self._name = stream, name

    def __getattr__(self, attribute: str) -> Any:
        return getattr(self._stream, attribute)

    def write(self, text: str) -> int:
        """As `TextIO.write`; `OSError` with the name of the stream, or `ReaderLeftError`."""
        with self._named():
            return self._stream.write(text)

    def flush(self) -> None:
        """As `TextIO.flush`; `OSError` with the name of the stream, or `ReaderLeftError`."""
        with self._named():
            self._stream.flush()

    @contextlib.contextmanager
    def _named(self) -> Iterator[None]:
        try:
            yield
        except BrokenPipeError:
            raise ReaderLeftError from None
        except OSError as fault:
            raise OSError(fault.errno, fault.strerror, self._name) from None


class UnfailingStream:
    """A text stream for progress: what it cannot take is lost, and ends nothing.

    `reader_left`: whether it was a pipe that nobody reads any more.
    """

    def __init__(self, stream: TextIO) -> None:
        self._stream = stream
        self.reader_left = False

    def __getattr__(self, attribute: str) -> Any:
        return getattr(self._stream, attribute)

    def write(self, text: str) -> int:
        """As `TextIO.write`, without its faults."""
        with self._unfailing():
            self._stream.write(text)
        return len(text)

    def flush(self) -> None:
        """As `TextIO.flush`, without its faults."""
        with self._unfailing():
            self._stream.flush()

    @contextlib.contextmanager
    def _unfailing(self) -> Iterator[None]:
        try:
            yield
        except OSError as fault:
            self.reader_left |= isinstance(fault, BrokenPipeError)


@contextlib.contextmanager
def standard_streams() -> Iterator[UnfailingStream]:
    """Within, stdout and stderr can be written to whatever they are; hands out stderr."""
    open_closed_descriptors()
    before = sys.stdout, sys.stderr
    out, err = (stream or open_null() for stream in before)
    for stream in (out, err):
        if isinstance(stream, io.TextIOWrapper):
            stream.reconfigure(encoding=encoding_of(stream), errors="replace")  # a letter that it lacks stops nothing
    unfailing = UnfailingStream(err)
    sys.stdout, sys.stderr = NamedStream(out, "standard output"), unfailing
    try:
        yield unfailing
    finally:
        unfailing.flush()
        sys.stdout, sys.stderr = before


def encoding_of(stream: TextIO) -> str | None:
    """UTF-8, as all files of the program have it, where `stream` is no terminal and nobody asks for another encoding;
    None: as it is."""
    return None if stream.isatty() or os.environ.get("PYTHONIOENCODING") else "utf-8"


def open_closed_descriptors() -> None:
    """Put /dev/null where a standard stream is closed; else the next file that is opened would become that stream."""
    while (descriptor := os.open(os.devnull, os.O_RDWR)) <= 2:
        os.set_inheritable(descriptor, True)
    os.close(descriptor)


def open_null() -> TextIO:
    """A stream that takes everything."""
    return open(os.devnull, "w", encoding="utf-8")
