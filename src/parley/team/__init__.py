"""Several robots at one order: who does what, and why. Knows no node; ways are handed in."""
