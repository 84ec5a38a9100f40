"""The page of ``wallkit play``: a local server, and what it shares with the replay."""
