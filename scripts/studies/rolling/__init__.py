"""How fast and how exactly cuts roll by the kernel, beside numpy and scipy."""
