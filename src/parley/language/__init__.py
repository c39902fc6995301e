"""What understands people: the interface and its implementations."""
