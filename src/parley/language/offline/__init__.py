"""Understanding operators' English without any model: words, phrases, references, plans (design section 5).

The way of a message: `control` (stop and its kin) -> `addressing` (for whom) -> `text` and `mending` (words,
typing errors) -> `clauses` and `conditions` -> `commands`, `facts`, `wishes`, `questions`, `own_state`,
`edits` and `replanning` (what each clause is), `stories` (what is only told around it) -> `scene` with
`grounding`, `relative`, `spatial` and `remembering` (what it refers to) -> `tasks`, `catalogue` (the steps).
`interpreter` holds it together, on top of `reading`, `changing` and `answering`; `recovery` and `failed_step`
are for failures, `pictures` for looks; `engine` is the interface.
"""

from parley.language.offline.engine import OfflineLanguage

__all__ = ["OfflineLanguage"]
