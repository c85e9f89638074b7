"""The study `watch`: how soon drifts are found and named, and how often nothing is found to be one."""
