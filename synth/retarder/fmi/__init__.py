"""Controller and position as units of the Functional Mock-up Interface (FMI 3.0 and 2.0, co-simulation)."""
