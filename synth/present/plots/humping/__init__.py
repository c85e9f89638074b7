"""Pictures of humped trains: time and speed over path, hump speeds, catch-ups on the plan, couplings and gaps."""
