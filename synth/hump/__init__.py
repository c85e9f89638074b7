"""The whole hump: its file, the control of its elements, and trains that roll over it."""
