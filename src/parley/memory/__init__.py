"""The memory store and its retrieval."""
