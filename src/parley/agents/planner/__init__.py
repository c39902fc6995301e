"""The UMRF planner: where a plan waits for a yes, is kept, sent and followed."""
