"""From a configuration to a book of validated tables."""
