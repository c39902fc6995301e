"""The chat interface: where a message is heard, understood and answered."""
