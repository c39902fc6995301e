"""The five nodes; each wires one thing to topics."""
