"""What a controller does in faults of its radar, and when it notices that a cut has another weight than it was told."""
