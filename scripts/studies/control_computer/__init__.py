"""The study `control-computer`: formulas beside simulation, published figures beside ours, failures, benefit, today."""
