"""How fast the control computer must be: its tasks, their waits and deadlines, word length, memory, inputs, outputs."""
