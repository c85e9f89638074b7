"""Tables that are there already: found, read, exported."""
