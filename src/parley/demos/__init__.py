"""The demonstrations: worlds, maps and stories as data."""
