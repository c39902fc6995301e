"""Words and wordings: the lexicon, cutting text, mending typing errors, saying plain sentences."""
