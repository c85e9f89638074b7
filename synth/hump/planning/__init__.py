"""What a control expects of cuts, and the speeds that it chooses: plan, feedback, aim."""
