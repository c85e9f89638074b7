"""Whether the program does on this machine what it did where it was tested: its qualification for a safety case.

Everything is asked through the command line of the installed program, as its user asks it.
"""
