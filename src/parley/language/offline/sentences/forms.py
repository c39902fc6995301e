"""One wish in many forms, each put as the plain order it means, before anything else is read.

The passive, what is wanted done, what is brought to the fore, recipes and deeds that are only named are all
the same order; what orders the deeds ("before A is V-ed", "once B has been W-ed") becomes their order.
"""

from __future__ import annotations

from parley.language.offline.facts.facts import strip_openers
from parley.language.offline.facts.framed import asked_to_keep
from parley.language.offline.scene.scene import Scene
from parley.language.offline.sentences.clauses import opens_command
from parley.language.offline.sentences.clefts import Clefts
from parley.language.offline.sentences.deeds import Deeds
from parley.language.offline.sentences.gaps import Gaps
from parley.language.offline.sentences.passive import Passives
from parley.language.offline.sentences.recipes import Recipes
from parley.language.offline.sentences.spoken import Names
from parley.language.offline.words.text import Phrase, Word, keys

__all__ = ["plainly_put"]

_MARKS = frozenset({".", "!", "?", ";", "\n"})
_LONGEST = 60


def plainly_put(words: Phrase, scene: Scene) -> Phrase:
    """A message with plain orders in place of the other forms that a wish may have.

    Args:
        words: All words and punctuation.
        scene: What is known.
    """
    robots = frozenset(name.lower() for name in (*scene.situation.robots, scene.situation.robot) if name)
    passives = Passives(Deeds.of(scene), Names(scene), robots, alone=_is_single(words))
    clefts = Clefts(Gaps(passives.deeds, passives.subjects.are_things, robots), passives.names.is_stop)
    recipes = Recipes(passives, lambda part: opens_command(part, scene.catalogue.verbs), scene.is_person)
    result: list[Word] = []
    start = 0
    for index in range(len(words) + 1):
        if index < len(words) and words[index].key not in _MARKS:
            continue
        sentence, mark = words[start:index], words[index : index + 1]
        kept = asked_to_keep(strip_openers(sentence))
        short = 2 < len(sentence) <= _LONGEST and not kept
        passives.before = tuple(result)
        said = recipes.put(passives.put(clefts.put(sentence, tuple(result)))) if short else sentence
        changed = keys(said) != keys(sentence)
        result += (*said, *((Word(".", "."),) if changed and keys(mark) == ("?",) else mark))
        start = index + 1
    return tuple(result)


def _is_single(words: Phrase) -> bool:
    """Whether a message is one sentence, with no clause of its own beside."""
    flat = keys(words)
    inner = {".", "!", "?", ";", ",", "\n", "else", "if", "otherwise", "because"} & set(flat[:-1])
    return not inner - {","} and ("," not in inner or flat[-2:-1] == ("please",))
