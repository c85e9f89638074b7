"""The limit that a system may set to the address space of a process (ulimit -v)."""

from __future__ import annotations


def address_space_limit_bytes() -> int | None:
    """That of this process; None where there is none, as always on Windows."""
    try:
        import resource
    except ImportError:
        return None
    limit, _ = resource.getrlimit(resource.RLIMIT_AS)
    return None if limit == resource.RLIM_INFINITY else limit
