"""One actor's action engine: commands in, feedback out."""
