"""What every command stands on: declared settings, its run, what it shows in every medium, its directory, workers."""
