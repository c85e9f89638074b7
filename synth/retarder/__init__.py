"""The controller of one retarder: from a configuration to a book of validated tables, and what else is asked of it."""
