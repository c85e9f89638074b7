"""When results were made: the one date that stands in files."""

from __future__ import annotations

import os
from datetime import UTC, datetime

from synth.frame.input_error import InputError


def creation_time() -> str:
    """Now in UTC, or the time of SOURCE_DATE_EPOCH (which makes a run's files reproducible to the byte)."""
    epoch = os.environ.get("SOURCE_DATE_EPOCH")
    moment = datetime.fromtimestamp(int(epoch), UTC) if epoch else datetime.now(UTC)
    return moment.strftime("%Y-%m-%dT%H:%M:%SZ")


def require_date() -> None:
    """`InputError` if SOURCE_DATE_EPOCH is set to what is no time."""
    text = os.environ.get("SOURCE_DATE_EPOCH")
    try:
        if text:
            datetime.fromtimestamp(int(text), UTC)
    except (OSError, OverflowError, ValueError):
        raise InputError(f"SOURCE_DATE_EPOCH is {text!r}; it must be whole seconds since 1970") from None
