"""What is told and remembered, and which of it matters for a message."""
