"""What the lines shall be good at; plain values."""
