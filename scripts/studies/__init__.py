"""The laboratory: what the machine was measured with. It uses the product; the product does not know it."""
