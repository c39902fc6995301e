"""How much sense one reading of a message makes, by what it explains and what it leaves over."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

from parley.language.offline.facts.remembering import find_fact
from parley.language.offline.readings.plausible import is_request, names_something
from parley.language.offline.scene.scene import Scene, UnclearError
from parley.language.offline.sentences.laconic import SEEN
from parley.language.offline.sentences.signs import LEADING
from parley.language.offline.sentences.units import Unit
from parley.language.offline.tasks.catalogue import parameter_role
from parley.language.offline.tasks.choices import choices_of
from parley.language.offline.tasks.tasks import UnableError
from parley.language.offline.words.lexicon import PhraseTable, lexicon
from parley.language.offline.words.nouns import bare, beside_at
from parley.language.offline.words.text import Phrase, keys, lemma, singular, tokens
from parley.messages.chat import ActionCall, ChatAction

__all__ = ["Judgement", "gone_to", "is_odd", "judge", "texts_of"]

_SAID = frozenset({"text", "question", "person"})
"""Inputs that may hold any words."""
_MOST_CHOICES = 6
"""More than these nobody can be asked to choose from."""
_PARTLY = "did not understand"
_WEIGHTS = {
    "against": 8.0,
    "lost": 4.0,
    "nonsense": 3.0,
    "unable": 1.5,
    "partly": 2.0,
    "unused": 1.5,
    "strayed": 1.0,
    "asks": 1.0,
    "unshared": 1.5,
    "left": 0.4,
}


@dataclass(frozen=True, slots=True)
class Judgement:
    """What speaks against a reading; nothing is best."""

    against: int = 0
    """Things that the plan goes to or looks at, though they are to be left alone."""
    lost: int = 0
    """It ends in not having understood."""
    nonsense: int = 0
    """Things to do something about that nothing can be called."""
    unable: int = 0
    """It ends in something that the robot cannot do."""
    partly: int = 0
    """Parts that it says it did not understand."""
    unused: int = 0
    """Things on the map that an order names, and that are not in the plan."""
    strayed: int = 0
    """Things that the plan is about, though nothing but a story names them."""
    asks: int = 0
    """It ends in a question."""
    unshared: int = 0
    """Looks that are asked for at each of several places, and are done at one."""
    left: int = 0
    """Words of orders that carry meaning and are neither in the plan nor in the reply."""

    @property
    def cost(self) -> float:
        """All of it, weighed; 0 is best."""
        return float(sum(weight * getattr(self, name) for name, weight in _WEIGHTS.items()))

    def __str__(self) -> str:
        """For people: what is counted, and the sum."""
        parts = [f"{name} {getattr(self, name)}" for name in _WEIGHTS if getattr(self, name)]
        return f"{self.cost:g} ({', '.join(parts) or 'nothing against it'})"


def judge(
    action: ChatAction,
    trouble: UnclearError | UnableError | None,
    units: Sequence[Unit],
    scene: Scene,
    spared: frozenset[str] = frozenset(),
) -> Judgement:
    """Judge one reading.

    Args:
        action: What the reading comes to.
        trouble: What ended it early, if anything.
        units: The parts of the message.
        scene: What is known.
        spared: The identifiers of what is to be left alone.
    """
    unclear = trouble if isinstance(trouble, UnclearError) else None
    asked = unclear is not None and bool(unclear.about) and not _can_be(unclear.about, units, scene)
    wrong = sum(_nonsense(step, scene) for step in action.queue) + _kept_orders(action, units)
    ordered = _named_in(units, {"order", "wish", "name", "idle", "condition"}, scene)
    stories = [unit for unit in units if not _leads_on(unit, units, action)]
    told = _named_in(stories, {"told", "reason"}, scene) - _named_in(
        units, {"order", "wish", "name", "asked"}, scene
    )
    used = _used(action, units, scene)
    return Judgement(
        against=len(gone_to(action, scene) & spared),
        lost=int(unclear is not None and unclear.lost),
        nonsense=wrong + asked,
        unable=int(isinstance(trouble, UnableError) and sum(unit.kind == "order" for unit in units) > 1),
        partly=action.message_response.count(_PARTLY)
        + int(
            bool(action.queue) and _UNKNOWN in action.message_response and "?" not in scene.situation.message
        )
        + _missed(action, trouble, units),
        unused=0
        if _changes_plan(action) or (unclear is not None and unclear.choices)
        else len(ordered - used),
        strayed=len(told & used) + _from_stories(action, units, scene)
        if ordered and not _points(units)
        else 0,
        asks=_asks(unclear, ordered, scene),
        unshared=_unshared(action, units, scene),
        left=0 if _changes_plan(action) or trouble is not None else _left(action, units, scene),
    )


def _leads_on(unit: Unit, units: Sequence[Unit], action: ChatAction) -> bool:
    """For "A moved to B. Go to A": what is told says where to go, and is kept."""
    if unit.kind != "told":
        return False
    told = set(keys(unit.words))
    ordered = {key for one in units if one.kind in {"order", "name"} for key in keys(one.words)}
    for command in action.system_cmd:
        info = keys(tokens(str(command.arguments.get("info", ""))))
        about = {key for key in info[1:-1] if key not in lexicon().determiners}
        data = {key for key in keys(tokens(str(command.arguments.get("data", "")))) if key.isalnum()}
        if info[:1] == ("where",) and about and about <= ordered and len(data - told - about) <= 1:
            return True
    return False


def gone_to(action: ChatAction, scene: Scene) -> frozenset[str]:
    """The identifiers of what new steps of a plan are about."""
    said = {
        text.lower()
        for text in texts_of([step for step in action.queue if step not in scene.situation.queue])
    }
    return frozenset(item.id for item in scene.objects if {item.description.lower(), item.id.lower()} & said)


def _missed(action: ChatAction, trouble: UnclearError | UnableError | None, units: Sequence[Unit]) -> int:
    """Whether nothing comes of an order that stands among stories."""
    if action.queue or trouble is not None or any(c.command != "add_memory" for c in action.system_cmd):
        return 0
    stories = any(unit.kind in {"told", "reason"} for unit in units)
    orders = (keys(unit.words) for unit in units if unit.kind == "order" and len(unit.words) > 2)
    return int(stories and any(not {"not", "never", "tell"} & set(words[:3]) for words in orders))


_OF_EACH = PhraseTable.of(
    [
        "(in|at|on) (each|both|all|every one)",
        "(each|both|all|every one) of (them|these|those)",
        "(them|those) (both|all)",
    ]
)


def _unshared(action: ChatAction, units: Sequence[Unit], scene: Scene) -> int:
    """How many orders are for each of several places, where the plan looks only once."""
    looking = [scene.catalogue.with_role(role) for role in ("look", "search", "count")]
    names = {info.name for info in looking if info is not None}
    looks = sum(step.name in names for step in action.queue)
    places = set(texts_of([step for step in action.queue if step.name not in names]))
    if looks != 1 or len(places) < _SEVERAL:
        return 0
    orders = [keys(unit.words) for unit in units if unit.kind == "order" and not unit.names]
    for unit, following in pairwise(units):
        both = unit.kind == "order" and len(unit.names) > 1 and unit.words[0].key in _ALONG
        if both and following.kind == "order" and not following.names:
            # "Go through A and B and look for C".
            return int(keys(following.words)[:3] in {("and", "look", "for"), ("and", "check", "for")})
    return sum(any(_OF_EACH.match(flat, i) is not None for i in range(len(flat))) for flat in orders)


_SEVERAL = 2
_ALONG = frozenset({"go", "drive", "walk", "run", "pass", "patrol", "visit"})


def _asks(unclear: UnclearError | None, ordered: set[str], scene: Scene) -> int:
    """How odd it is to ask: which of several is meant is fair, unless the message names one of them."""
    if unclear is None or unclear.lost:
        return 0
    if not unclear.choices or len(unclear.choices) > _MOST_CHOICES:
        return 1
    named = {item.description for item in scene.objects if item.id in ordered}
    either = "or" in keys(tokens(scene.situation.message.lower()))
    return 2 * bool(named & set(unclear.choices) and not either)


def _left(action: ChatAction, units: Sequence[Unit], scene: Scene) -> int:
    """How many words that carry meaning an order has and neither the plan nor the reply."""
    text = " ".join([*texts_of(action.queue), action.message_response])
    there = {part for word in keys(tokens(text.lower())) for part in (word, singular(word), lemma(word))}
    robots = {key for name in scene.situation.robots for key in keys(tokens(name))}
    count = 0
    for unit in units:
        if unit.kind not in {"order", "wish"} or not action.queue:
            continue
        named = {key for name in unit.names for key in keys(name)} | robots
        said = (
            {key for key in _due_whenever(unit.words) if _means_something(key)} - named - _beside(unit.words)
        )
        count += sum(not {key, singular(key), lemma(key)} & there for key in said)
    return count


def _beside(words: Phrase) -> set[str]:
    """The words that only say what something is beside ("the door next to the lift")."""
    flat = keys(words)
    starts = (end for i in range(1, len(flat)) if (end := beside_at(flat, i)) > i)
    return {key for start in starts for key in flat[start : start + _LONGEST_ANCHOR]}


_LONGEST_ANCHOR = 3


def _means_something(key: str) -> bool:
    lex = lexicon()
    if not key.isalpha() or len(key) < 3:
        return False
    telling = (lex.nouns, lex.meaningful, lex.hazards, lex.incidents, SEEN)
    known = key in lex.vocabulary or lemma(key) in lex.vocabulary
    return not known or any(key in words for words in telling)


def _changes_plan(action: ChatAction) -> bool:
    """Whether more than new steps come of it: then the reply names what is not to be done."""
    return any(command.command != "add_memory" for command in action.system_cmd)


def _points(units: Sequence[Unit]) -> bool:
    """Whether an order points at what was told before it, for nothing was asked for yet."""
    for unit in units:
        if unit.kind in {"order", "wish"} and _POINTING & set(keys(unit.words)):
            return True
        if unit.kind == "order" and not unit.names and set(_due_whenever(unit.words)) <= _BARE_ORDERS:
            return True
        if unit.kind in {"order", "wish", "name"} and unit.names:
            return False
    return False


def _due_whenever(words: Phrase) -> tuple[str, ...]:
    """The words of an order without those that say when it is due."""
    flat = keys(words)
    while (found := LEADING.match(flat)) is not None and found[0] < len(flat):
        flat = flat[found[0] :]
    return flat


_BARE_ORDERS = frozenset({
    "go", "and", "have", "a", "look", "check", "see", "take", "off", "you", "please", "inspect", "do",
    "now", "then",
})  # fmt: skip
_UNKNOWN = "I do not know that."
_POINTING = frozenset({"it", "them", "there", "that", "this", "those", "these", "him", "her", "one", "ones"})


def _from_stories(action: ChatAction, units: Sequence[Unit], scene: Scene) -> int:
    """How many things that are not on the map only a story names."""
    told = {key for unit in units if unit.kind in {"told", "reason"} for key in keys(unit.words)}
    asked = {key for unit in units if unit.kind not in {"told", "reason"} for key in keys(unit.words)}
    count = 0
    for value in texts_of(action.queue):
        words = {key for key in keys(tokens(value)) if key.isalnum()}
        known = any(value.lower() in {item.description.lower(), item.id.lower()} for item in scene.objects)
        count += not known and words <= told and not words & asked
    return count


def texts_of(steps: Sequence[ActionCall]) -> list[str]:
    """The inputs in words of some steps."""
    return [
        str(parameter.value)
        for step in steps
        for parameter in step.input_parameters.values()
        if parameter.has_data and isinstance(parameter.value, str)
    ]


def _kept_orders(action: ChatAction, units: Sequence[Unit]) -> int:
    """How many memories hold an order."""
    orders = [" ".join(keys(unit.words)) for unit in units if unit.kind == "order" and len(unit.words) > 2]
    kept = [
        " ".join(keys(tokens(str(command.arguments.get("data", "")))))
        for command in action.system_cmd
        if command.command == "add_memory"
    ]
    return sum(any(order in text for order in orders) for text in kept)


def _can_be(words: Phrase, units: Sequence[Unit], scene: Scene) -> bool:
    """Whether words that are asked about can be a name; what holds the name of something known is none."""
    flat = " ".join(keys(bare(words)))
    names = (" ".join(keys(bare(name))) for unit in units for name in unit.names)
    if any(f" {name} " in f" {flat} " and name != flat for name in names):
        return False
    return scene.ground(words).outcome != "none" or names_something(words)


def is_odd(step: ActionCall, scene: Scene) -> bool:
    """Whether a step is about something that nothing can be called."""
    roles = {
        role
        for info in scene.catalogue.infos
        if info.name == step.name
        for role in scene.catalogue.roles(info)
    }
    return _leaves_open(step) or (bool(roles & {"look", "search"}) and _nonsense(step, scene) > 0)


def _leaves_open(step: ActionCall) -> bool:
    """Whether a step is for "everything except A" where nothing tells what that is."""
    said = (
        keys(tokens(parameter.value.lower()))
        for name, parameter in step.input_parameters.items()
        if parameter.has_data and isinstance(parameter.value, str) and parameter_role(name) not in _SAID
    )
    return any(flat[:1] and flat[0] in _WHOLE and {"except", "but"} & set(flat) for flat in said)


_WHOLE = frozenset({"all", "every", "each", "everything", "everywhere"})


def _nonsense(step: ActionCall, scene: Scene) -> int:
    """How many inputs of a step nothing can be called."""
    info = scene.catalogue.get(step.name)
    offered = choices_of(info) if info is not None else {}
    values = [
        str(parameter.value)
        for name, parameter in step.input_parameters.items()
        if parameter.has_data and isinstance(parameter.value, str) and parameter_role(name) not in _SAID
        # "On" is no name, but one of what an input may be.
        if parameter.value not in offered.get(name, {}).values()
    ]
    return sum(not _makes_sense(tokens(value), scene) for value in values if value)


def _makes_sense(words: Phrase, scene: Scene) -> bool:
    if is_request(words) or (1 < len(words) < 4 and words[-1].key[-1:].isdigit()):
        # "Well A1" is a label.
        return True
    text = " ".join(keys(words))
    if any(text in {item.id.lower(), item.description.lower()} for item in scene.objects):
        return True
    return find_fact(words, scene.facts)[0] is not None and names_something(words)


def _named_in(units: Sequence[Unit], kinds: set[str], scene: Scene) -> set[str]:
    """The ids of what the parts of some kinds name."""
    begun = next((at for at, unit in enumerate(units) if unit.names), len(units))
    phrases = (
        p
        for at, unit in enumerate(units)
        if unit.kind in kinds and not unit.refuses
        for p in unit.names
        if not _belongs_elsewhere(bare(p), unit.words, scene)
        and not (at > begun and len(bare(p)) == 1 and scene.is_part(bare(p)[0]))
    )
    return {item.id for phrase in phrases for item in scene.ground(phrase).candidates[:1]}


def _belongs_elsewhere(name: Phrase, words: Phrase, scene: Scene) -> bool:
    """For "the door of the shed", where the only door of the map is far from the shed."""
    return len(name) == 1 and any(
        word.key == name[0].key and scene.has_its_own(words, at, at + 1) for at, word in enumerate(words)
    )


def _used(action: ChatAction, units: Sequence[Unit], scene: Scene) -> set[str]:
    """The ids of what the plan or the reply names, by its own words or by the operator's."""
    values = [
        str(parameter.value).lower()
        for step in action.queue
        for parameter in step.input_parameters.values()
        if parameter.has_data
    ]
    said = re.sub(r"I (?:will )?remember[^.]*\.", "", action.message_response)
    text = " | ".join([*values, said.lower()])
    return {
        item.id for item in scene.objects if item.description.lower() in text or item.id.lower() in values
    }
