"""Rules of the house, and what robots do when they see something."""
