"""Exit speeds that aim a cut at the standing cars: what is known of it, what the position makes of a command."""
