"""Tables with an estimator of the speed."""
