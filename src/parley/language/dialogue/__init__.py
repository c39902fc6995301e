"""The dialogue: what is open, what runs, what was done and seen, and what of it answers a message."""
