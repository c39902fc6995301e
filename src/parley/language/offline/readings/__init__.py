"""Several ways to read one message, and which of them makes the most sense."""
