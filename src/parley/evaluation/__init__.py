"""How well language engines understand: sets of situations, a judge, and figures side by side."""
