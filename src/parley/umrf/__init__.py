"""UMRF graphs: model, reading and writing, checking, parameters, catalogue, execution. Knows no transport."""
