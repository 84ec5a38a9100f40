"""Free space between walls: how far the nearest wall is, and how triangles of free space hang together."""
