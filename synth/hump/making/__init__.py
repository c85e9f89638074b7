"""A hump file from the few facts of a short file: a tree of tracks that part at given places."""
