"""Understanding operators' English without any model: words, phrases, references, plans (design section 5).

The way of a message: `control` (stop and its kin) -> `text` (words, typing errors) -> `clauses` ->
`commands`, `facts`, `questions`, `edits` (what each clause is) -> `scene` (what it refers to) -> `tasks` and
`catalogue` (the steps). `interpreter` holds it together, `engine` is the interface.
"""

from parley.language.offline.engine import OfflineLanguage

__all__ = ["OfflineLanguage"]
