"""Polynomial lines: fitted to switching lines, polished, kept within what is required, and made a table."""
