"""Understanding operators' English without any model."""
