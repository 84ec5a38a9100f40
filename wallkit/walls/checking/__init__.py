"""What is wrong with walls: violations, free space, leaks, narrow places."""
