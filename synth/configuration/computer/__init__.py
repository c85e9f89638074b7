"""The configuration of `retarder-synth computer`."""
