"""How fast the kernels solve the tool's own problem, beside numpy and beside what the machine can do at most."""
