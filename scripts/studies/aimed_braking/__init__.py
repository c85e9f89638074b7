"""Aimed braking: the figures of Kozachenko and of the prototypes beside ours, and which assumption moves them."""
