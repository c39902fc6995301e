"""The error handler: where a failed step is repaired, alone or by asking."""
