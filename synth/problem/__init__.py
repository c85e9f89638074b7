"""What is to be solved, and what the lines shall be good at."""
