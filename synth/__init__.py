"""Control tables of a hump-yard car retarder, from a problem to a validated table; and the hump around it.

A problem is loaded, solved, fitted and tabulated; its table is predicted, simulated, compared and drawn. Besides: exit
speeds of a park position, trains over a whole hump, and the numbers of a position from its measured passes. The plant
is `plant_models`, tables and books as files are `tuning_tables`. What does not fit raises `InputError`, `PlantError` or
`TableError`, each a `ValueError` with one sentence.

This import is instant: what a name stands for is imported when it is first used. The first solve compiles the kernels.
"""

from synth.frame.declared_names import declared_names

__getattr__, __dir__ = declared_names(__name__, __file__)
del declared_names
