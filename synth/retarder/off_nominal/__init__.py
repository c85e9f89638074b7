"""What tables do where plant or sensor are not what they were made for; it informs, and no limit follows from it."""
