"""What a frame must look like: on the CPU, in float64."""
