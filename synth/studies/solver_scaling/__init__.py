"""What a solve costs against each size of the problem, on more threads, and in float32."""
