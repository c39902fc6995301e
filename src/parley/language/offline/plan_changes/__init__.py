"""Changes of what is pending: dropping, keeping, moving, replacing, repeating."""
