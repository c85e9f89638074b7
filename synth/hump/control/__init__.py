"""The control of a hump: what its elements do while a train is humped ([kozachenko-control], [hump-computer-1970s]).

A `HumpControl` runs a train of a sorting list on a track; its log of events leads to the same state again.
"""

from synth.frame.declared_names import declared_names

__getattr__, __dir__ = declared_names(__name__, __file__)
del declared_names
