"""The built-in engine of `--language builtin`: annotate, read by two witnesses, ground, decide, say.

Nothing in here rewrites text: a message is annotated, never edited (docs/language-builtin.md).
"""
