"""The on-line correction in the closed loop: pass after pass, on a plant that stays and on plants that drift."""
