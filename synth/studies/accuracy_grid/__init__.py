"""The study `accuracy-grid`: how near the tables are to what physics leaves, over a whole grid of cases."""
