"""Software in the loop: the exported C controller, compiled, as a process of its own."""
