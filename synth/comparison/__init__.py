"""What a table is set beside: the friction known, other laws, the limit cycle, python-control."""
