"""One ball from contact to contact: change the physics here."""
