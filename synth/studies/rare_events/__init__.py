"""Probabilities of exits that are too fast by so much that plain simulation hardly ever sees one."""
