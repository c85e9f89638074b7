"""What exit-speed accuracy is worth on the track: cuts that roll to the standing cars, and the speeds that aim them."""
