"""What a table is compared with: tuned classical laws, bounds, limit cycles."""
