"""Pictures of capacities."""
