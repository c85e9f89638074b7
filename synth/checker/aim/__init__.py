"""The checker's own reading of aim tables, their rule, and their exports."""
