"""Pictures, replays, films and the page."""
