"""What an aim configuration may contain, how it is read, and a commented one to start from."""
