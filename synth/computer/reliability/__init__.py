"""How reliable the control computer is: its states, its maintenance, its redundancy, and what failures cost."""
