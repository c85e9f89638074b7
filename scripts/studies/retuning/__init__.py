"""How much of what can be recovered do tables recover that are tuned for measured passes?"""
