"""The REST side of the page: one file per resource; all below `/api`."""
