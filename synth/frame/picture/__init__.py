"""How pictures look, and the bytes of their files."""
