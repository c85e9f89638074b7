"""One page to play with: in the browser a table brakes cuts by its own rule, on a small copy of the plant."""
