"""Tables of ordinary cuts, drawn at random over the whole library, beside tuned classical rules."""
