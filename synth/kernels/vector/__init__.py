"""Packs of numbers that the processor works on at once."""
