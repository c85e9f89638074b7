"""Structured Text as the tools of PLC engineers import it: one export, laid out in several forms."""
