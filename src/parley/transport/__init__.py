"""Transports behind one interface."""
