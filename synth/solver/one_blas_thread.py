"""Linear algebra on one thread, wherever bytes depend on it.

BLAS cuts its work into as many parts as it has threads, so the last bit of a minimum found with it would depend on the
machine and on OPENBLAS_NUM_THREADS. Our matrices are small and our threads many: more would only be in the way.
"""

from __future__ import annotations

import threading
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager

from threadpoolctl import threadpool_limits

# How many threads BLAS has is known once in a process, whoever asks: so is who needs it to be one.
_changing = threading.Lock()
_limits = ExitStack()
_holders = 0


@contextmanager
def one_blas_thread() -> Iterator[None]:
    """Within, in all threads of this process, BLAS uses one thread; may be nested, and is a decorator too.

    Who leaves last restores what was. It cannot where other threads hold it longer than the thread that entered first,
    as only that one may change the number; one thread it remains then.
    """
    import scipy.linalg  # noqa: F401  # brings a BLAS of its own, which can be limited only once it is there

    global _holders
    with _changing:
        if _holders == 0:
            _limits.enter_context(threadpool_limits(1, user_api="blas"))
        _holders += 1
    try:
        yield
    finally:
        with _changing:
            _holders -= 1
            if _holders == 0:
                _limits.close()
