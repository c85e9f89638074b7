"""The verdict on tables, and what a tune leaves in its directory."""
