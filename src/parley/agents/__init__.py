"""The nodes that talk, plan, repair, remember and show; each wires one thing to topics."""
