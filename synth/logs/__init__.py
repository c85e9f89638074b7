"""What measured passes of a retarder say of its numbers, of its tables, and of a drift."""
