"""When a ball first touches a line, an arc or a corner."""
