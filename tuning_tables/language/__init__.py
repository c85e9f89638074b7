"""One text for each rule: plain Python that numba compiles, printed as C99, Structured Text and JavaScript.

Read in this order: `records` (what a controller holds, declared once), `tree` (the language as frozen values),
`reading` (a Python function as such a tree), `folding` (what an export has no room for is left out), `c99`,
`structured_text` and `javascript` (the printers).
"""
