"""What is shown of a book of tables: a module for each chapter of its page."""
