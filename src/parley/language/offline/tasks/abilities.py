"""What the robot can do, said in words people use."""

from __future__ import annotations

from parley.language.offline.scene.scene import Scene
from parley.language.offline.tasks.catalogue import parameter_role, text_inputs
from parley.language.offline.words.lexicon import lexicon
from parley.language.offline.words.naming import name_words
from parley.language.offline.words.saying import a, listing, whole_sentence
from parley.language.offline.words.text import lemma, singular
from parley.messages.status import ActionInfo

__all__ = ["abilities", "can_list", "cannot"]

_BY_ROLE = {
    "motion": "go to places and things I know",
    "look": "look at things and tell you what I see",
    "search": "look for things and people",
    "grasp": "pick things up",
    "handover": "hand things over",
    "fetch": "bring things",
    "place": "put things down",
    "speak": "say something",
    "answer": "answer questions",
    "follow": "follow people",
    "guide": "lead people",
    "meet": "meet people",
    "count": "count things",
    "ask_operator": "ask you when I need help",
    "wait": "wait",
    "dock": "go to my charger",
}


def can_list(scene: Scene) -> list[str]:
    """One phrase for each thing the robot can do."""
    result: dict[str, None] = {}
    for info in scene.catalogue.infos:
        roles = scene.catalogue.roles(info)
        known = [_BY_ROLE[role] for role in sorted(roles) if role in _BY_ROLE]
        if known and not _is_narrow(info):
            result.update(dict.fromkeys(known))
        elif "locate" not in roles:
            result[_described(info)] = None
    return list(result)


def _is_narrow(info: ActionInfo) -> bool:
    """Whether an action does what it is good for to one kind of thing only ("shelve_book", "check_trap")."""
    topic = [word for word in name_words(info.name)[1:] if word not in lexicon().goals_and_places]
    inputs = [name for name in text_inputs(info) if not parameter_role(name)]
    return bool(inputs) and any(word in name_words(name) for word in topic for name in inputs)


def _described(info: ActionInfo) -> str:
    if info.description.strip():
        words = info.description.strip().split(". ")[0].rstrip(".").split()
        # "Drives to the dock and charges": what it does, in the form that follows "I can".
        words = [
            lemma(word.lower()) if i == 0 or words[i - 1] == "and" else word for i, word in enumerate(words)
        ]
        return " ".join(words)
    name = name_words(info.name)
    verb, what = (name[0] if name else info.name), " ".join(name[1:])
    if what and name[-1] not in lexicon().goals_and_places:
        return f"{verb} {what if singular(name[-1]) != name[-1] else a(what)}"
    return f"{verb} {what}".strip() + (" something" if text_inputs(info) else "")


def abilities(scene: Scene) -> str:
    """A sentence saying what the robot can do."""
    can = can_list(scene)
    if not can:
        return "I have no actions at the moment."
    return whole_sentence(f"I can {listing([*can, 'remember what you tell me'])}")


_TURNED = {"me": "you", "my": "your", "i": "you", "us": "you", "yourself": "myself"}


def cannot(what: str, scene: Scene) -> str:
    """That something is not possible, and what is."""
    turned = " ".join(_TURNED.get(word.lower(), word) for word in what.split())
    turned = turned[:1].lower() + turned[1:]
    shown = turned if len(turned) <= 80 else turned[:77] + "..."
    return f"I cannot {shown}. {abilities(scene)}"
