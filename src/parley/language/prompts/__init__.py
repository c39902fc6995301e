"""What a language model is told: composed at run time, in one place, for every question (design section 5).

`texts/` holds the standing instructions, one file per question; `data` puts what is known into blocks that no
content can break out of; `composer` makes a `Prompt` of both. A prompt's version changes with its text.
"""

from parley.language.prompts.composer import (
    KINDS,
    Kind,
    Prompt,
    compose_ground,
    compose_inspect,
    compose_interpret,
    compose_reply,
    compose_resolve,
    compose_selection,
)

__all__ = [
    "KINDS",
    "Kind",
    "Prompt",
    "compose_ground",
    "compose_inspect",
    "compose_interpret",
    "compose_reply",
    "compose_resolve",
    "compose_selection",
]
