"""Humping of trains: cuts roll from the crest through the positions to their tracks, and meet on the way."""
