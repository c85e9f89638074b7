"""Closed-loop passes of a cut, and figures of their exits."""
