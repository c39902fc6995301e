"""Measurements: figures for people to compare, never tests that time."""
