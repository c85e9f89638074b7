"""Cuts that roll freely, one after the other, forwards and backwards."""
