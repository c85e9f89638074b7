"""Aimed braking: the figures of S1 and of the prototypes beside ours, and which assumption moves them."""
