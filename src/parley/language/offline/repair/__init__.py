"""What to do about a failed step (thesis 4.3.7), alone or with the operator's answer."""
