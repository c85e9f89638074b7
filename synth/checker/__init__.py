"""A second opinion on exported tables: small, dissimilar, and on its own.

It is written from `docs/reference/table-format.md` and the model, shares no line with the solver, the simulator or the
exporters, and needs Python's standard library alone (h5py, where there is a book to read). What it checks and what it
does not is in `docs/explanation/verification.md`.
"""
