"""What a lost scheduler makes other libraries tell: nothing, also where they have loggers with levels of their own."""

from __future__ import annotations

import io
import logging

from synth.frame.workers.dask_cluster import LOGGERS, SCHEDULER_LOST, silence


def test_the_whole_tree_of_loggers_is_silent_and_no_other() -> None:
    told = io.StringIO()
    handler = logging.StreamHandler(told)
    names = ["silent", "silent.client", "silent.client.deep", "silently"]
    loggers = [logging.getLogger(name) for name in names]
    for logger in loggers:
        logger.setLevel(logging.WARNING)
        logger.addHandler(handler)
        logger.propagate = False
    silence(("silent",))
    for logger in (*loggers, logging.getLogger("silent.later")):
        logger.critical("%s", logger.name)
    assert told.getvalue() == "silently\n"
    assert "distributed" in LOGGERS
    assert "sweep" not in SCHEDULER_LOST
