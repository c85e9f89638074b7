"""Accuracy against time in the position: tables for several prices of a second."""
