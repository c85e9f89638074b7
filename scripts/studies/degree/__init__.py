"""Study: which degree the polynomial lines need (R4)."""
