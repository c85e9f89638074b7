"""Unlocked mode: a command may be given at every sample, also during a transient."""
