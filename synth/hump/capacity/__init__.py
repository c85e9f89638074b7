"""How fast a hump can hump at a share of catch-ups: curves over programs or speeds, of a trial and of changes to it."""
