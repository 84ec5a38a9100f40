"""What is known of a level before it is played."""
