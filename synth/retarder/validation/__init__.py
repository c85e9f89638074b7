"""The closed loop of exported tables, simulated once more."""
