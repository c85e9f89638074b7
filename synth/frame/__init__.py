"""What every command stands on: the directory that its results go to, held by one and changed by nobody else."""
