"""What permissions of the hardware would give: commands at any time, an estimator, an approach."""
