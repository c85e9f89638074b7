"""How fast a sweep makes tables, and in what memory."""
