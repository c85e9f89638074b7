"""The one error for a fault in what the user gave."""

from __future__ import annotations


class InputError(ValueError):
    """The input is at fault; the message is one sentence: file, key, value, what is allowed, what to do."""
