"""A hump trial: its configuration with every default filled in, and the trial that is made of it."""
