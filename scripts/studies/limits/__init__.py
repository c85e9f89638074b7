"""The study `limits`: what limits the accuracy."""
