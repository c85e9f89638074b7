"""What is shown of humped trains: figures, places, positions, one train, its program."""
