"""The pictures of an aim: what exit speeds give on the track, and what tables command."""
