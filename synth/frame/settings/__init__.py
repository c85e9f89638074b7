"""Declared settings: their files, faults, templates and lists."""
