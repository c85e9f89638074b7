"""The command `aim`, which may be given the track of a hump file."""
