"""The configuration of a book of tables that a position needs in a hump trial."""
