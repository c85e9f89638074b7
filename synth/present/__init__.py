"""Pictures and reports of what a tune found, and the directory that holds them."""
