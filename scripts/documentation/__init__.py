"""The pages of the documentation site that follow from the program: its commands, and its public Python names."""
