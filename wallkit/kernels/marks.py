"""What becomes of a kernel in the machine code of those that call it."""

INLINE = "inline"
"""It stands in its callers."""
CALLED = "called"
"""It stays a call if LLVM finds it large."""
ALONE = "alone"
"""It is optimised by itself, and then stands in its callers."""
