"""Tables for point sensors: switching speeds for every passage over a sensor, and the rule that reads them."""
