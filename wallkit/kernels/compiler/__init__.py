"""From the Python of kernels to machine code: see ``whole``."""
