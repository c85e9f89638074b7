"""The simulated position in real time at the other end of a controller's cable."""
