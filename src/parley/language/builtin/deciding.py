"""One decision of all that a message says: certain, or a question."""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence
from dataclasses import replace

from parley.gate.assent import assent_of, gives_up
from parley.gate.control import control_of
from parley.gate.orders import NOT_SEEN
from parley.language.base import Situation
from parley.language.builtin.addressing import addressed, for_nobody
from parley.language.builtin.answers import answer, look_asked_for
from parley.language.builtin.checks import whole_names
from parley.language.builtin.decision import Answer, Ask, Control, Decision, Deed, Do, Remember, Told
from parley.language.builtin.deeds import Builder
from parley.language.builtin.facts import Heard, listing, places, rule_of, rule_of_sight, told_of
from parley.language.builtin.lexicon import Lexicon, stem
from parley.language.builtin.planner import Planner, contradicted, orders_of
from parley.language.builtin.reading import Reading
from parley.language.builtin.saying import listed, which_one
from parley.language.builtin.sights import sight_asked_for
from parley.language.builtin.skills import Skills
from parley.language.builtin.spans import Filler
from parley.language.builtin.structure import Part, Unclear, arranged
from parley.language.builtin.tokens import spoken, tokenize
from parley.language.builtin.wishes import Wish
from parley.language.dialogue import policy
from parley.language.dialogue.facts import is_report, is_wish, own_words
from parley.language.dialogue.indirect import meant
from parley.language.dialogue.map_words import named
from parley.language.dialogue.speaker import Again, name_of
from parley.language.dialogue.standing import read_rule
from parley.language.lexicon import word_set
from parley.messages.memory import MemoryEntry
from parley.world.object_map import MapObject

__all__ = ["decide"]


def decide(
    situation: Situation,
    parts: tuple[Part, ...],
    skills: Skills,
    lexicon: Lexicon,
    reader: Callable[[str], Reading],
    again: Again,
) -> Decision:
    """What to do, ask, change, remember or say, of a message whose clauses are `parts`.

    `reader` reads what is remembered; `again` decides about a part of the message or what was said before.
    """
    tokens = spoken(tokenize(situation.message)) or tokenize(situation.message)
    whole = reader(situation.message)
    made = _decided(Heard(situation, tokens, parts, whole, skills, lexicon, reader, again))
    made = for_nobody(made, situation, tokens, lexicon, again) or made
    called = addressed(situation, tokens) if isinstance(made, Ask) else ()
    if isinstance(made, Ask) and not isinstance(called, Ask) and situation.robot not in called:
        return replace(made, robots=called)  # it is their order that is asked about
    return made


def _decided(heard: Heard) -> Decision:
    situation, lexicon, whole = heard.situation, heard.lexicon, heard.reading
    indirect = meant(heard.tokens, (situation.robot,), lexicon, heard.again)
    if indirect is not None:
        return indirect
    early = policy.beforehand(heard)
    if early is not None:
        return early
    listed = listing(situation.message, situation.objects, lexicon)
    if listed is not None:
        return Remember((listed,))
    if (ruled := _ruled(heard)) is not None:
        return ruled
    made = _alone(heard)
    if _asks_ability(situation.message, whole, lexicon) and orders_of(whole)[0].frame in heard.skills:
        return Answer("Yes, I can do that. Tell me which, and I will.")
    if isinstance(made, Answer) and not made.sources and "question" in whole.acts and not situation.question:
        made = _looking(heard) or made
    if (
        isinstance(made, Answer)
        and made.unknown
        and "LOOK" in heard.skills
        and _WHERE.search(situation.message)
    ):
        about = f"look for {made.unknown}"
        made = Ask(f"{made.text} Where shall I look?", where=made.unknown, about=about)
    open_ask = isinstance(made, Ask) and not (made.choices or made.alarms or made.where)
    if open_ask and not situation.question and "told" not in whole.acts:
        made = _sight(heard) or made
    if isinstance(made, Ask) and (promise := policy.promised(situation, lexicon, heard.again)) is not None:
        return promise
    made = policy.afterwards(made, heard)
    if isinstance(made, Ask) and not (made.offer or made.choices or situation.queue or situation.question):
        made = _offered(made, heard)
    tells = "told" in whole.acts or _I_AM.search(situation.message) is not None
    missed = isinstance(made, Do) and any("operator" in deed.arguments.values() for deed in made.deeds)
    if tells and (missed or (isinstance(made, Ask) and not made.alarms)):
        told = policy.no_facts(_beside(situation.message, heard.again), situation, beside=True)
        told = heard.told_in(situation.message) if is_report(situation.message) else told  # until one looks
        made = _for_who_is_there(situation, told, heard.again) or made
        return replace(made, told=told) if isinstance(made, Ask) else made
    return made


def _ruled(heard: Heard) -> Decision | None:
    """What to do in a case, with an order or alone: "check bays 1 and 2, and stop if you see a leak"."""
    for joint in _AND.finditer(message := heard.situation.message):
        case = _THERE_IS.sub(r"\1 you see", message[joint.end() :])
        rule = read_rule(case)
        if rule is not None and all(act.kind in ("stop", "tell", "cancel") for act in rule.acts):
            kept, made = heard.again(case), heard.again(message[: joint.start()])
            if isinstance(kept, Remember) and isinstance(made, Ask):
                return made  # an answer brings the whole message back
            if isinstance(kept, Remember) and isinstance(made, Do):
                goals = [deed.said["G"] for deed in made.deeds if not deed.hidden and "G" in deed.said]
                if len(goals) == sum(not deed.hidden for deed in made.deeds):  # only who looks sees something
                    looks = heard.again(f"check {listed(goals)}")
                    made = looks if isinstance(looks, Do) else made
                return replace(made, told=(*made.told, *kept.told))
    alone = rule_of(heard.parts, message, heard.lexicon)
    if alone is None and not named(heard.tokens, heard.situation.objects, heard.lexicon):
        alone = rule_of_sight(message, heard.lexicon)
    return Remember((alone,)) if alone is not None else None


_WHERE = re.compile(r"\b(?:where|here|there|still|seen?)\b", re.IGNORECASE)
_THERE_IS = re.compile(r"\b(if|when|as soon as) there(?: is| are|['’]s)\b", re.IGNORECASE)
_AND = re.compile(r"[\s,;.]+(?:and|but)\s+|[.;!]\s+", re.IGNORECASE)


def _asks_ability(message: str, reading: Reading, lexicon: Lexicon) -> bool:
    """Whether it is asked what can be done with things of a kind, no one of them: "can you open gates?"."""
    asks = message.lower().startswith("can you ") and message.rstrip().endswith("?")
    orders = orders_of(reading)
    things = orders[0].all("T") if len(orders) == 1 and len(orders[0].fillers) == 1 else ()
    small = lexicon.classes["determiners"] | lexicon.classes["quantifiers"]
    return asks and any(not {*f.words} & small and len(f.words) == 1 and _is_many(f.words[0]) for f in things)


def _is_many(word: str) -> bool:
    return word.endswith("s") and stem(word) != word


def _for_who_is_there(situation: Situation, told: tuple[Told, ...], again: Again) -> Do | None:
    """The order of a message that else only says where the speaker is: "I'm at the desk, come here"."""
    entries = [MemoryEntry(name=fact.name, data=fact.text) for fact in told]
    if not told or any(name_of(situation).lower() not in fact.text.lower() for fact in told):
        return None
    made = [again(piece, told=entries) for piece in _pieces(situation.message)]
    orders = [one for one in made if not isinstance(one, Remember)]
    if len(orders) != 1 or not isinstance(orders[0], Do):
        return None
    notes = tuple(note for note in orders[0].notes if note.source not in {fact.name for fact in told})
    return replace(orders[0], notes=notes, told=(*orders[0].told, *told))


def _looking(heard: Heard) -> Do | Ask | None:
    """A look where only that tells: what is there is looked at, how something is is offered to be."""
    situation, tokens, lexicon = heard.situation, heard.tokens, heard.lexicon
    sight = _sight(heard)
    if sight is not None:
        return sight
    names = named(tokens, situation.objects, lexicon)
    spaces = [] if names else named(tokens, situation.rooms, lexicon)
    vague = {token.low for token in tokens} & (
        lexicon.classes["clock"] | {"true", "possible", "ok", "you", "me"}
    )
    it = None if names or spaces or vague else policy.spoken_of(situation, (), lexicon)[0]
    if isinstance(it, MapObject):  # "is it open?", "is there a cup on it?"
        tokens = tokenize(_IT.sub(f"the {it.description}", situation.message, count=1))
        names = named(tokens, situation.objects, lexicon)
    called = {word for robot in situation.robots for word in robot.lower().split()}
    order = look_asked_for(tokens, names or spaces, called)
    order = f"go to the {spaces[0].text} and {order}" if order and spaces else order
    made = heard.again(order) if order else None
    if isinstance(made, Ask) and made.choices:
        return made
    if not isinstance(made, Do) or {*made.robots} - {situation.robot}:
        return None
    return Ask("I cannot tell that from here. Shall I go and look?", offer=made.deeds, unclear=NOT_SEEN)


_IT = re.compile(r"\bit\b", re.IGNORECASE)


def _sight(heard: Heard) -> Do | Ask | None:
    """The look that is asked for, with the way there."""
    situation, tokens, lexicon = heard.situation, heard.tokens, heard.lexicon
    names = named(tokens, situation.objects, lexicon)
    rooms = [] if names else named(tokens, situation.rooms, lexicon)
    robots = addressed(situation, tokens)
    sight = sight_asked_for(situation, tokens, names or rooms, lexicon, counting="COUNT" in heard.skills)
    if sight is None or sight.frame not in heard.skills or situation.queue or isinstance(robots, Ask):
        return None
    builder, words = Builder(situation, heard.skills, lexicon, ()), rooms[0].words if rooms else ()
    there = Filler("G", 0, len(words), len(words) - 1, words)
    way = builder.deeds(Wish("GO", 0, "go", (there,), 1.0, "agrees")) if rooms else []
    deeds = way if isinstance(way, Ask) else builder.deeds(sight)
    if isinstance(way, Ask) or isinstance(deeds, Ask):
        return deeds if isinstance(deeds, Ask) else None
    return Do((*way, *deeds), tuple(builder.notes), (), robots)


_NO_FACT = "I did not understand that as a fact about where something is. What shall I do with it?"
_KEEP = "Shall I remember that? If there is something to do, please say what."
_SENTENCE = re.compile(r"\w[^.,;:!?]*")
_I_AM = re.compile(r"\b(?:i|we)(?: a|['’])(?:m|re)\b", re.IGNORECASE)
_BINDING = re.compile(r"\b(?:if|unless|until|when|while|or|because|but|not)\b", re.IGNORECASE)


def _pieces(message: str) -> list[str]:
    return [found[0].strip() for found in _SENTENCE.finditer(message)]


def _beside(message: str, again: Again) -> tuple[Told, ...]:
    """The facts of a message that is asked about: whole sentences on which nothing in it depends."""
    pieces = _pieces(message)
    if len(pieces) == 1 or _BINDING.search(message):
        return ()
    made = [again(piece) for piece in pieces]
    return tuple(fact for one in made if isinstance(one, Remember) for fact in one.told if not fact.is_rule)


def _offered(made: Ask, heard: Heard) -> Ask:
    """What is amiss is not remembered, and what is only named is not driven to: to go there is offered."""
    situation, tokens, lexicon = heard.situation, heard.tokens, heard.lexicon
    names = named(tokens, situation.objects, lexicon) or named(tokens, situation.rooms, lexicon)
    guess = made.question == _NO_FACT and _GUESS.search(situation.message) is not None
    amiss = guess or is_report(situation.message)
    if not (amiss or policy.only_names(situation, tokens, names, lexicon)):
        return _to_keep(made, situation, lexicon)
    if not amiss and len(names[0].things) > 1:
        which = tuple(thing.description for thing in names[0].things)
        return Ask(which_one(which), which)
    places = [name.things[0] for name in names if len(name.things) == 1]
    if not places:
        return _to_keep(made, situation, lexicon)
    words = tuple(places[-1].description.lower().split())
    frame, role = ("LOOK", "T") if amiss else ("GO", "G")
    about = Filler(role, 0, len(words), len(words) - 1, words)
    deeds = Builder(situation, heard.skills, lexicon, ()).deeds(Wish(frame, 0, "", (about,), 1.0, "agrees"))
    what = f"the {places[-1].description}{' and have a look' if amiss else ''}"
    return made if isinstance(deeds, Ask) else Ask(f"Shall I go to {what}?", offer=tuple(deeds))


_GUESS = re.compile(r"\b(?:i (?:think|guess|suppose|believe)|probably|maybe|perhaps|might|should be)\b", re.I)


def _to_keep(made: Ask, situation: Situation, lexicon: Lexicon) -> Ask:
    """Whether to remember what is told and is neither a fact about a place nor a wish."""
    text = own_words(situation.message)
    whom = lexicon.classes["pronouns"] | lexicon.classes["persons"]  # nobody knows later who that was
    if made.question != _NO_FACT or is_wish(text) or whom & {*re.findall(r"\w+", text.lower())}:
        return made
    first, small = text.split(" ", 1)[0].lower(), lexicon.classes["small"] | lexicon.classes["determiners"]
    text = f"{first}{text[len(first) :]}" if first in small and first != "i" else text
    return Ask(_KEEP, (f"remember that {text}",))


def _alone(heard: Heard) -> Decision:
    """What a message says by itself."""
    situation, parts, lexicon = heard.situation, heard.parts, heard.lexicon
    told = policy.no_facts(_told(situation, parts, lexicon), situation)
    orders = [wish for part in parts for wish in orders_of(part.reading)]
    if not orders:
        whole = _whole([part.reading for part in parts if part.clause.link == "main"])
        return _without_order(replace(heard, reading=whole), told)
    robots = addressed(situation, tokenize(situation.message))
    if not isinstance(robots, Ask):
        together = len(situation.robots) > 1 and robots == situation.robots
        parts = tuple(_without_call(part, situation.robots or (situation.robot,), together) for part in parts)
    doubt = robots if isinstance(robots, Ask) else None
    nodes = arranged(parts, lexicon)
    if isinstance(nodes, Unclear):
        doubt = doubt or Ask(nodes.question)
    if doubt is not None or isinstance(nodes, Unclear):
        return doubt or Ask("Can you say it in other words?")
    now = [MemoryEntry(name=fact.name, data=fact.text) for fact in told]
    known = places((*situation.memory, *now), heard.reader, lexicon)
    builder = Builder(situation, heard.skills, lexicon, known)
    builder.tells = any("told" in part.reading.acts for part in parts)
    sought = any({*f.words} <= {"it", "them"} for w in orders if w.frame == "FIND" for f in w.all("T"))
    thing, person = policy.spoken_of(situation, known, lexicon, sought=sought)
    visits = all(wish.frame in ("GO", "LOOK", "PHOTO") for wish in orders)
    builder.recall(thing or (policy.subject_of(situation, parts, lexicon) if visits else None), person)
    deeds = Planner(builder).planned(nodes)
    if isinstance(deeds, Ask):
        return builder.doubts[0] if builder.doubts else deeds
    if (both := contradicted(deeds, builder.refused)) is not None:
        return both
    if (dropped := _dropped(parts, deeds, builder)) is not None and builder.doubts is None:
        return dropped
    while deeds and deeds[-1].open_ended:
        deeds.pop()
    if not deeds and builder.doubts is not None and any(w.negated and w.witness == "unknown" for w in orders):
        return builder.doubts[0]
    if not deeds:
        left = " ".join(note.text for note in builder.notes)
        return Answer(f"All right. {left}") if left else Ask("I stay here. What shall I do?")
    if builder.doubts is not None:
        asked, unclear = builder.doubts
        return replace(asked, offer=tuple(deeds), unclear=unclear)
    return Do(tuple(deeds), tuple(builder.notes), told, () if isinstance(robots, Ask) else robots)


_ANCHORS = word_set("""of near by beside behind under above below next opposite close with between in on
inside past around without except but not""")
_PICKING = word_set("nearest closest furthest farthest between nearer closer left right")
"""What leads to a name that only tells where something else is, or what is left out."""


def _dropped(parts: Sequence[Part], deeds: Sequence[Deed], builder: Builder) -> Ask | None:
    """A question about what an order names and no deed is about; None if nothing is lost."""
    lexicon, told = builder.lexicon, [note.text for note in builder.notes]
    for deed in deeds:
        told += [*map(str, deed.arguments.values()), *deed.said.values(), deed.text]
    text = " ".join(told).lower()
    idle = lexicon.classes["determiners"] | {"to"}
    for part in parts if deeds else ():
        own = any(wish.own for wish in part.reading.wishes)
        low = part.parse.tokens if part.clause.link == "main" and not own else ()
        verbs = {at for verb in part.parse.verbs for at in range(verb.start, verb.end)}
        words = [token.low for token in low]
        found = whole_names(words, builder.situation.objects, lexicon)
        for start, thing in found:
            before = [word for word in words[:start] if word not in idle]
            anchors = {*before[-3:]} & _ANCHORS or {*before[-4:]} & _PICKING
            called_alike = sum(start == other for other, _ in found) > 1
            behind = start + len(thing.description.split())
            one_thing = words[start - 1 : start] == ["the"] and any(behind == other for other, _ in found)
            called_alike |= one_thing  # the coffee of "the coffee table"
            if anchors or called_alike or start in verbs or part.parse.acts[start] != "order":
                continue
            refused = any(thing.description in one for _, one in builder.refused)
            small = {*thing.description.lower().split()} <= lexicon.classes["small"]
            if not (refused or small or any(name.lower() in text for name in (thing.description, thing.id))):
                return Ask(f"What shall I do with the {thing.description}? Please say it in other words.")
    return None


def _told(situation: Situation, parts: tuple[Part, ...], lexicon: Lexicon) -> tuple[Told, ...]:
    """The facts among what is said as such: not those that something depends on."""
    found: list[Told] = []
    for part in parts:
        if part.clause.link == "main":
            starts = [token.start for token in part.parse.tokens]
            ends = part.parse.tokens[-1].end
            found = [*told_of(part.reading, situation.message[:ends], starts, lexicon, found)]
    return tuple(found)


def _whole(readings: list[Reading]) -> Reading:
    """What several clauses say together."""
    if len(readings) == 1:
        return readings[0]
    return Reading(
        frozenset(act for reading in readings for act in reading.acts),
        tuple(wish for reading in readings for wish in reading.wishes),
        tuple(filler for reading in readings for filler in reading.loose),
        tuple(word for reading in readings for word in reading.left_over),
    )


def _without_call(part: Part, robots: tuple[str, ...], together: bool) -> Part:
    """A clause in which the words that call the robots are accounted for."""
    calling = {name.lower() for name in robots}
    calling |= {"robot", "robots", "all", "both", "two", "everyone", "everybody"} if together else set()
    left = tuple(word for word in part.reading.left_over if word.lower() not in calling)
    loose = tuple(f for f in part.reading.loose if not {*f.words} <= calling | {"and", "of", "you", ","})
    unsteady = tuple(word for word in part.reading.unsteady if word not in calling)
    return replace(part, reading=replace(part.reading, left_over=left, loose=loose, unsteady=unsteady))


def _without_order(heard: Heard, facts: tuple[Told, ...]) -> Decision:
    situation, reading, lexicon = heard.situation, heard.reading, heard.lexicon
    command = control_of(situation.message, situation.robots)
    if command is not None:
        called = addressed(situation, tokenize(situation.message))
        robots = () if isinstance(called, Ask) else called
        return Control("stop" if command == "emergency_stop" else command, robots)
    if facts:
        return Remember(facts)
    if "question" in reading.acts:
        before, _ = policy.spoken_of(situation, (), lexicon)
        before = before if isinstance(before, MapObject) and before not in situation.rooms else None
        return answer(situation, reading, lexicon, heard.reader, before)
    if not situation.question and situation.dialogue.asked is None and gives_up(situation.message):
        return Answer("All right.")
    if assent_of(situation.message) and not situation.question and situation.dialogue.asked is None:
        if situation.dialogue.plan == "paused":
            return Answer("I am still standing still. Say “carry on” when I should go on.")
        return Ask("I have not asked anything that a yes would answer. What shall I do, and with what?")
    if "need" in reading.acts:
        return Ask("What can I do about it? Tell me what to bring, or where to go.")
    names = named(heard.tokens, situation.objects, lexicon) or named(heard.tokens, situation.rooms, lexicon)
    if reading.acts == {"social"} and not policy.only_names(situation, heard.tokens, names, lexicon):
        leaves = policy.LEAVES.search(situation.message.lower())
        return Answer("Goodbye." if leaves else "Hello. Tell me what I can do for you.")
    if situation.message.rstrip().endswith("?"):
        return answer(situation, reading, lexicon, heard.reader)
    if "told" in reading.acts:
        return Ask(_NO_FACT)
    return Ask("I did not understand that. What shall I do, and with what?")
