"""Study: commands at any time, and the surfaces by which they are given."""
