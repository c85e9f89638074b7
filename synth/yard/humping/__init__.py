"""Whole trains over the hump: cuts that roll on their routes one behind the other."""
