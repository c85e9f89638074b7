"""Point sensors along a position: tables for them, and where they should stand."""
