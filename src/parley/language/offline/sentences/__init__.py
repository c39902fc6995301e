"""The shape of a message: clauses, conditions, lists, run-on speech, other ways to say the same."""
