"""Times of calls that are compared, and the machine that they were taken on."""
