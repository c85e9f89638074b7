"""Study `structure`: do the named parts of the loop, run one by one as they are wired, give the simulator's pass?"""
