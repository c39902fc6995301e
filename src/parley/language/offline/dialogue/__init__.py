"""Which robot is meant, questions and their answers, and answers to our own questions."""
