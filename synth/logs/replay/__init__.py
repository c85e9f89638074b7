"""What another table would have done in measured passes, and whether what came out is what was predicted."""
