"""What the dialogue decides before and after an order is read: answer, correct, remember, help."""

from __future__ import annotations

import itertools
import re
from collections.abc import Sequence
from dataclasses import replace
from typing import Final

from parley.gate.assent import gives_up, takes_all_back
from parley.gate.control import control_of
from parley.language.base import Situation
from parley.language.builtin.answers import most_asked
from parley.language.builtin.decision import Answer, Ask, Decision, Do, Edit, Forget, Remember, Told
from parley.language.builtin.facts import Heard, Place
from parley.language.builtin.lexicon import Lexicon, lemmas
from parley.language.builtin.lexicon import lexicon as lexicon_of_words
from parley.language.builtin.own import is_promised
from parley.language.builtin.reading import Reading
from parley.language.builtin.reply import said as words_for
from parley.language.builtin.saying import which_one
from parley.language.builtin.structure import Part
from parley.language.builtin.tokens import Token, tokenize
from parley.language.dialogue import facts
from parley.language.dialogue.answers import answer, differences
from parley.language.dialogue.changes import Change, before_all, change_of, reordered, texts_of, visits
from parley.language.dialogue.choosing import choice_of, in_order, tells
from parley.language.dialogue.emergency import NO_ALARM, danger_is_past, emergency, is_emergency
from parley.language.dialogue.following import followed
from parley.language.dialogue.indirect import PROMISE, due, put_off
from parley.language.dialogue.map_words import Named, in_room, named, named_alone, rooms
from parley.language.dialogue.questions import plain, question_of
from parley.language.dialogue.rearranging import rearranged
from parley.language.dialogue.replies import is_thinking
from parley.language.dialogue.speaker import Again, answered_place, told_place
from parley.language.dialogue.standing import tells_in_case
from parley.language.lexicon import word_set
from parley.messages.plain import in_words
from parley.umrf.kinds import words_of_name
from parley.world.object_map import MapObject

__all__ = ["LEAVES", "afterwards", "beforehand", "no_facts", "only_names", "promised", "spoken_of"]


_ALL: Final = (
    r"that(?: is|'s| was| will be|'ll be) (?:all|it|everything)(?: for(?: now| today| the moment)?)?"
)
_SOCIAL: Final = re.compile(
    r"(?:good (?:morning|day|evening|night|afternoon)|hello|hi|hey|bye|goodbye|see you(?: later)?|"
    rf"thank(?:s| you)(?! (?:and |but )?(?:then|now|next)\b)(?: \w+){{0,5}}(?: {_ALL})?|"
    rf"{_ALL}(?: thanks| thank you)?|"
    r"(?:that (?:was|is)|that's) (?:nice|great|good|perfect|lovely|fine|quick|fast)|"
    r"cheers|well done|good (?:job|boy|robot|work)|nice|great|perfect|cool|wow|haha+.*|lol|"
    r"(?:i(?: am|'m) )?sorry|(?:sorry )?my (?:mistake|bad|fault)|"
    r"you(?: are|'re| r) .+)"
)
LEAVES: Final = re.compile(r"\b(?:good ?night|(?:good)?bye|see you)\b")
"""What is said to go, in small letters."""
_TURNS: Final = 8
_ANSWER: Final = 10
"""So many words a choice among several things has at most."""


def beforehand(heard: Heard) -> Decision | None:
    """What is decided without reading orders."""
    situation, reading, lexicon, again = heard.situation, heard.reading, heard.lexicon, heard.again
    said = emergency(heard)
    if said is None:
        said = _LEFT if takes_all_back(situation.message) else _about_itself(heard)
    if said is not None:
        return said
    asked = situation.dialogue.asked
    last = next((turn.content for turn in reversed(situation.history) if turn.role == "operator"), "")
    one = asked is not None and len(asked.choices) == 1 and asked.words == last
    if (one or is_emergency(situation)) and (agreed := _agreed(situation, reading, again)) is not None:
        return afterwards(agreed, heard)
    chose = answered_place(situation, lexicon, again) or choice_of(situation, heard.tokens, again)
    chose = chose or in_order(situation, again)
    if chose is not None:
        return chose
    meant = _about_what_was_said(heard)
    if meant is not None:
        return meant
    here = told_place(situation, lexicon)
    if here is not None:
        return here
    moved = facts.moved_fact(heard)
    return Remember((moved,)) if moved is not None else _of_whom(last, heard)


def _of_whom(last: str, heard: Heard) -> Remember | None:
    """What is told of "she", where it was told or asked just before of somebody by name."""
    asks = last.rstrip().endswith("?")
    said = _OF_ONE.match(heard.situation.message)
    name = _INNER.search(last) if asks else facts.NAME.match(last)
    told = said and name and (asks or heard.reader(last).acts & {"told", "need"})
    made = heard.again(f"{name[0].strip()}{said['rest']}") if said and name and told else None
    return made if isinstance(made, Remember) else None


_INNER: Final = re.compile(r"(?<=[a-z] )[A-Z][a-z]+")
_OF_ONE: Final = re.compile(
    r"\W*(?:(?:and|but|oh|well|so)\W+)*(?:she|he)(?P<rest>(?:['’]s| is| has) .+)", re.IGNORECASE
)


def _agreed(situation: Situation, reading: Reading, again: Again) -> Decision | None:
    """What was asked last, where that is said yes to."""
    asked = situation.dialogue.asked
    there = all({*f.words} <= {"there"} for wish in reading.wishes for f in wish.fillers)
    if asked is None or not asked.choices or "yes" not in reading.moves or not there:
        return None
    made = again(asked.choices[0])
    if isinstance(made, Remember | Edit):
        return made
    return replace(made, about=asked.words) if isinstance(made, Do) else None


_LEFT: Final = Answer("All right, then I leave it.")


def _calmed(heard: Heard) -> Answer | None:
    """What is said to who tells that there is no danger, or none any more."""
    situation, bare = heard.situation, heard.bare
    past = danger_is_past(situation.message, heard.lexicon)
    safe = NO_ALARM.fullmatch(bare) is not None
    if (safe or past) and (is_emergency(situation) or bare.startswith("false alarm")):
        more = " Say “carry on” when I should go on." if situation.queue else ""
        return Answer(f"I am glad to hear that. I stay here.{more}")
    return Answer("I am glad to hear that.") if past else None


def _about_itself(heard: Heard) -> Decision | None:
    """A question about the robot, a wish to forget, a word to wait."""
    situation, bare = heard.situation, heard.bare
    chooses = bare in ("any", "any one") and situation.dialogue.asked is not None
    question = None if chooses or is_promised(bare, situation.catalogue) else question_of(bare)
    if question is None and situation.message.rstrip().endswith("?"):  # "Kim looked for you, where were you?"
        question = question_of(plain(tokenize(_LAST.sub("", situation.message)), (situation.robot,)))
    asked = situation.dialogue.asked
    if not bare and not situation.question:  # nothing but its name
        return Answer("Yes, I hear you: I read every word.")
    if question is not None and question.topic == "difference" and asked is not None:
        return Answer(f"{differences(asked.choices, situation.objects)} Which one do you mean?")
    if question is not None and (said := answer(question, situation)):
        return Answer(said)
    away = _AWAY.fullmatch(bare)
    if away is not None and _is_place(away["out"] or away["left"], heard):
        return Ask("Where shall I go instead?")
    lost = facts.taken_back(situation, bare, heard.told_in) or facts.forgotten(situation, bare)
    if lost and bare.startswith("forget ") and any(entry.way == "seen" for entry in lost):
        named = re.fullmatch(r"forget (?!about |all |what |that |where |everything )(.+)", bare)
        if named is not None:  # mostly that is said of what is to be done
            more = f"forget about {named[1]}"
            return Ask(f"Do you mean what I have seen of that? Then say “{more}”.", (more,))
    if lost:
        texts = (entry.data.rstrip(".") if entry.type == "text" else in_words(entry.name) for entry in lost)
        return Forget(tuple(entry.name for entry in lost), tuple(texts))
    if lost is not None and situation.memory and bare.startswith("forget") and not _known_plan(situation):
        return Answer("I know nothing of that, so there is nothing to forget.")
    if (calmed := _calmed(heard)) is not None:
        return calmed
    if is_thinking(situation.message if situation.question else bare):
        return Answer("Take your time. I wait.")
    return None


_AWAY: Final = re.compile(
    r"(?:get|go|come|drive|move) (?:right )?(?:out of|away from) (?P<out>.+)|leave (?P<left>.+)"
)
"""To be gone from somewhere, whatever the goal is."""


def _is_place(words: str, heard: Heard) -> bool:
    """Whether words are a room, or a thing to be gone from, and nothing else."""
    name = re.sub(r"^(?:the|this|that|my|her|his) ", "", words)
    return name in ("room", "house", "area", "place", "here", "there") or any(
        name == place.description.lower() for place in heard.situation.places
    )


_LAST: Final = re.compile(r"^.*[,.;!–-]\s+(?=\S)", re.DOTALL)
"""All but the last piece of a message."""


def _about_what_was_said(heard: Heard) -> Decision | None:
    """Something once more, later, instead; or what nobody like this robot can do."""
    situation, reading, tokens, lexicon = heard.situation, heard.reading, heard.tokens, heard.lexicon
    again = heard.again
    if (repeated := _once_more(situation, heard.bare)) is not None:
        return repeated
    if (refused := _beyond(heard)) is not None:
        return refused
    if (less := _on_with_less(situation, again)) is not None:
        return less
    order = due(situation.message, situation.dialogue.waiting)
    if order and _ordered(late := again(order)) is not None:
        return late
    instead = _TAKEN_BACK.match(situation.message)
    if instead is None and not visits(situation):
        instead = _INSTEAD.match(situation.message)
    if instead is not None:
        asked = again(instead["rest"])
        made = _ordered(asked)
        if made is not None:
            return afterwards(made, heard)
        unclear = isinstance(asked, Ask) and asked.choices and "told" not in reading.acts
        if unclear or (isinstance(asked, Edit) and asked.change.drop):  # "no, hang on, only the gate"
            return asked
    if (meant := _meant(heard)) is not None:
        return meant
    change = rearranged(situation, tokens, lexicon) or change_of(situation, tokens, lexicon, orders=False)
    if change is None and situation.dialogue.orders:
        change = followed(situation, tokens, lexicon, situation.dialogue.orders[-1])
    if change is None and instead is not None and _GIVEN_UP.match(situation.message):
        return asked if isinstance(asked, Ask) and any(w.act == "order" for w in reading.wishes) else None
    return _edit(change, situation) if change is not None else None


def _meant(heard: Heard) -> Decision | None:
    """What was said last about what is meant: "the crate, I mean", where no answer was found before."""
    said, turns = _MEANT.fullmatch(heard.situation.message), heard.situation.history
    last = next((turn.content for turn in reversed(turns) if turn.role == "operator"), "")
    if said is None or not last or visits(heard.situation) or heard.situation.question:
        return None
    reading = heard.reader(last)
    fillers = [*(filler for wish in reading.wishes for filler in wish.fillers), *reading.loose]
    named = [one.text for one in fillers if one.role in "TGL" and last.count(one.text) == 1]
    return heard.again(last.replace(named[-1], said["one"] or said["other"])) if named else None


_MEANT: Final = re.compile(
    r"\W*(?:(?:no|sorry|oh)\W+)*"
    r"(?:i (?:mean|meant) (?P<one>the [^,.;]+)|(?P<other>the [^,.;]+?),? i (?:mean|meant))\W*",
    re.I,
)


def _on_with_less(situation: Situation, again: Again) -> Edit | None:
    """For "go on, but skip the desk": the plan is changed; going on has a word of its own, for people."""
    for joint in _JOINT.finditer(situation.message):
        first, rest = situation.message[: joint.start()], situation.message[joint.end() :]
        if control_of(first, situation.robots) == "start":
            made = again(rest)
            still = situation.dialogue.plan in ("paused", "held")
            if not isinstance(made, Edit) or made.do is not None or made.change.add:
                return None
            said = f"{made.change.said} Say “carry on” when I should go on." if still else made.change.said
            return replace(made, change=replace(made.change, said=said))
    return None


_GIVEN_UP: Final = re.compile(
    r"\W*(?:\w+\W+)?(?:never ?mind|forget (?:all (?:of )?)?(?:it|that|this))\b", re.IGNORECASE
)
"""Said before something else: only that is to be understood."""
_JOINT: Final = re.compile(r"[\s,;.]+(?:(?:but|and|only|just|then)\W+)*(?=\w)", re.IGNORECASE)


def _ordered(made: Decision) -> Do | None:
    """The deeds of a decision, if it is certain of some."""
    return made if isinstance(made, Do) else made.do if isinstance(made, Edit) else None


_TAKEN_BACK: Final = re.compile(
    r"\W*(?:(?:oh|no|ah|ok|okay|well|hm+|please|sorry|actually|wait|ugh|fine|right)\W+)*"
    r"(?:(?:(?:forget|skip)(?: about)? (?:all (?:of )?)?(?:it|that|this)|"
    r"never ?mind(?: (?:about )?(?:all (?:of )?)?(?:it|that|this))?|"
    r"(?:scratch|drop|leave|cancel) (?:all (?:of )?)?(?:that|it)|not that)"
    r"(?=\s*(?:[^\w\s]|(?:and|then|just|please|instead|now|but|go|come|drive|check|look|take|bring)\b))|"
    r"change of plans?|on second thoughts?|i(?: have|'ve)? changed my mind|that was wrong|nope|"
    r"no(?! (?:need to (?!hurry)|need for|one|more|way|matter|longer)\b)|"
    r"i mean|i meant|(?:sorry|oops|wait|hang on|hold on)(?=\s*[,.;:!]))"
    r"\W+(?:(?:and|then|please|just|rather|instead|now|but|no|wait|sorry|hang on|hold on|i mean|i meant)\W+)*"
    r"(?P<rest>\w.+?)(?:,? (?:instead|rather))?\W*$",
    re.IGNORECASE | re.DOTALL,
)
_INSTEAD: Final = re.compile(r"(?P<rest>.+?),? (?:instead|rather)\W*$", re.IGNORECASE | re.DOTALL)
_AGAIN: Final = re.compile(
    r"(?:(?:can|could|will) you )?(?:please )?(?:do|repeat|make)?(?: ?(?:that|it|this|the same|"
    r"the same thing|the last thing|all of "
    r"(?:that|it)|the whole thing))?(?: ?(?:again|once more|one more time|another time|over again|twice|"
    r"anew))?"
)


def _once_more(situation: Situation, bare: str) -> Decision | None:
    """For "do that again": what was ordered last, as it was understood then."""
    again = re.search(
        r"\b(?:again|once more|one more time|another time|repeat|same)\b", situation.message.lower()
    )
    if again is None or _AGAIN.fullmatch(bare) is None or situation.question or situation.queue:
        return None
    if not situation.dialogue.orders:
        return Answer("I have not done anything yet that I could do again.")
    last = situation.dialogue.orders[-1]
    return Edit(Change(add=last.calls, said=f"I do that again: “{last.words.strip()}”."))


def _beyond(heard: Heard) -> Decision | None:
    """What none of its actions can do: said so, with the nearest thing that it can."""
    situation, reading, tokens, lexicon = heard.situation, heard.reading, heard.tokens, heard.lexicon
    orders = [wish for wish in reading.wishes if wish.act == "order" and not wish.negated]
    verbs = {word for wish in orders for word in lemmas(wish.verb.split(" ")[0])} if orders else set()
    small, led = lexicon.classes["small"], lexicon.classes["determiners"]
    first = next((token.low for token in tokens if token.low not in small), "")
    if any(token.low in led and behind.low == first for token, behind in itertools.pairwise(tokens)):
        first = ""  # "my phone"
    can = tokens[0].low == "can" and len(tokens) > 2 and tokens[1].low == "you"  # "can you dance?"
    first = tokens[2].low if can else first if "order" in reading.acts else ""
    verb = next(iter((verbs | {first}) & lexicon.classes["impossible"]), "")
    known = {
        word
        for info in situation.catalogue
        for word in re.findall(r"[a-z]+", f"{info.name} {info.description} {' '.join(info.phrases)}".lower())
    }
    if not verb or verb in known or situation.question or tells_in_case(situation.message):
        return None
    places = named_alone(tokens, situation.objects, lexicon)
    near = f" I can go to the {places[-1].description}, if that helps." if places else ""
    return Answer(f"I am sorry, I cannot {verb}: none of my actions does that.{near}")


def _known_plan(situation: Situation) -> bool:
    dialogue = situation.dialogue
    asks_where = dialogue.asked is not None and bool(dialogue.asked.where)
    return bool(situation.queue) or dialogue.proposal is not None or asks_where


def promised(situation: Situation, lexicon: Lexicon, again: Again) -> Answer | None:
    """The promise to do an order when somebody tells what it waits for; None if it waits for nothing."""
    if (waits := put_off(situation.message)) is not None and (do := _ordered(again(waits[1]))) is not None:
        what = " and ".join(words_for(deed, lexicon) for deed in do.deeds if not deed.hidden)
        return Answer(f"{PROMISE}: {waits[0]}. Then I {what}.", waits=True)
    return None


_IN_PLACE: Final = re.compile(
    r"^(?:no[,;:.!]+ |rather |instead,? )|\W+(?:instead|rather)(?=\W*$)", re.IGNORECASE
)


def _instead(made: Decision, heard: Heard) -> Decision:
    """The order to be done in the place of what is planned, whatever it is: "take a picture instead"."""
    situation, order = heard.situation, _IN_PLACE.sub("", heard.situation.message)
    asks = isinstance(made, Ask) and not made.choices and _known_plan(situation)
    wanted = heard.again(order) if asks and order != situation.message else made
    return wanted if isinstance(wanted, Do) else made


def afterwards(made: Decision, heard: Heard) -> Decision:
    """What is made of what was decided about the message alone."""
    situation, reading, bare = heard.situation, heard.reading, heard.bare
    made = _instead(made, heard)
    if isinstance(made, Do):
        if made.robots and situation.robot not in made.robots:
            return made  # nothing of what this one does or offers is meant
        proposal = situation.dialogue.proposal
        if proposal is not None and proposal.why and not situation.queue:
            return Edit(Change(), made, proposal.id)  # what was only offered gives way to an order
        if (between := _in_between(made, situation)) is not None:
            return between
        change = change_of(situation, heard.tokens, heard.lexicon, orders=True)
        if change is None and situation.queue and is_emergency(situation):
            change = before_all(situation)
        return made if change is None else _edit(change, situation, made)
    if isinstance(made, Ask) and not made.offer and (hands := _handless(situation, reading)):
        return replace(made, question=f"{hands} {made.question}")
    if isinstance(made, Ask) and (asked := _asked_again(made, heard)) is not None:
        return asked
    offers = isinstance(made, Ask) and made.offer
    if isinstance(made, Ask) and not offers and (met := _INTRODUCED.fullmatch(situation.message.strip())):
        return Answer(f"Hello, {met['name']}. What can I do for you?")
    ordered = any(wish.act == "order" for wish in reading.wishes)  # "thank you, go back"
    if isinstance(made, Ask | Answer) and not (offers or ordered) and _SOCIAL.fullmatch(bare):
        if LEAVES.match(bare):
            return Answer("Goodbye.")
        greets = re.match(r"hello|hi\b|hey|good (?:morning|day|evening|afternoon)|you\b|sorry", bare)
        return Answer("Hello. What can I do for you?" if greets else "You are welcome.")
    if offers or not isinstance(made, Ask | Answer | Remember):
        return made
    return _of_what_is_told(made, heard)


def _of_what_is_told(made: Decision, heard: Heard) -> Decision:
    """What is made of something that is told: it may be about the plan, or worth keeping."""
    situation, reading = heard.situation, heard.reading
    ordered = any(wish.act == "order" for wish in reading.wishes)
    if not ordered and (asked := _superfluous(situation, heard.tokens, heard.lexicon)) is not None:
        return asked
    if isinstance(made, Remember):
        return made
    fact = facts.other_fact(situation, reading, heard.bare)
    return Remember((fact,)) if fact is not None and not _is_robots_work(fact.text, situation) else made


_INTRODUCED: Final = re.compile(
    r"(?:(?:Hello|Hi|Hey|Good \w+)(?: \w+)?[,.!] *)?(?:I am|I'm|I’m|[Mm]y name is|[Tt]his is) "
    r"(?P<name>[A-Z][\w'’-]+)(?:,? (?:the|your|from|(?:and )?I(?: am|['’]m| work)) [\w ]+)?[.!]?"
)
"""For "I'm Maria, the new guard"."""
_AROUND: Final = re.compile(
    r"\b(?:(?P<before>before)|after|(?:done|finished) (?:with|at|in))\b", re.IGNORECASE
)


def _in_between(made: Do, situation: Situation) -> Decision | None:
    """An order that is to come before or after a place of the plan: put in there; that is not done twice."""
    said, plan = _AROUND.search(situation.message), visits(situation)
    shown = [deed for deed in made.deeds if not deed.hidden and deed.frame == "GO"]
    several = sum(not deed.hidden for deed in made.deeds) > 1
    if said is None or not plan or not (several and shown) or any(deed.check for deed in made.deeds):
        return None
    edge = shown[-1] if said["before"] else shown[0]
    first = made.deeds.index(edge) - (len(made.deeds) > 1 and made.deeds[made.deeds.index(edge) - 1].hidden)
    rest = tuple(d for at, d in enumerate(made.deeds) if not first <= at <= made.deeds.index(edge))
    place = {str(value).lower() for deed in made.deeds[first:][:2] for value in deed.arguments.values()}
    meant = [at for at, visit in enumerate(plan) if place & {t.description.lower() for t in visit.things}]
    behind = plan[meant[0] :] if said["before"] and meant else plan[meant[-1] + 1 :] if meant else []
    if not meant or (edge is made.deeds[-1]) is not bool(said["before"]):
        return None
    names = {thing.description for visit in plan for thing in visit.things}
    if names & {str(value) for deed in rest for value in deed.arguments.values()}:
        return Ask("That is in my plan already. Shall I do it in another order?")
    change = reordered(plan, [], behind, "instead", said="All right.")
    return _edit(change, situation, replace(made, deeds=rest))


def _asked_again(made: Ask, heard: Heard) -> Ask | Answer | None:
    """The question which of several things is meant, once more, where an answer to it says nothing.

    None of them may be meant too: then nothing is asked any more.
    """
    situation, reading, tokens = heard.situation, heard.reading, heard.tokens
    asked = situation.dialogue.asked
    if asked is not None and asked.where and gives_up(situation.message, situation.robots):
        return _LEFT
    short = sum(token.is_word for token in tokens) <= _ANSWER
    answers = asked is not None and asked.choices and not (made.choices or made.offer or made.stops)
    told = "told" in reading.acts and tells([token.low for token in tokens if token.is_word])
    asks = "question" in reading.acts or situation.message.rstrip().endswith("?")
    if asked is None or not answers or not short or reading.wishes or told or asks:
        return None
    if not {*asked.choices} <= {item.description for item in situation.objects}:
        return None
    if gives_up(situation.message, situation.robots) or _NONE.fullmatch(heard.bare):
        return _LEFT
    return Ask(f"I did not understand that. {which_one(asked.choices)}", asked.choices, about=asked.words)


_NONE: Final = re.compile(
    r"(?:(?:no|nope|sorry|oh|well) )*(?:no|nope|none|neither|nothing|not any)"
    r"(?: of (?:them|those|these|the two))?(?: thanks| thank you| please)?"
)
_BY_HAND: Final = {
    "GIVE": ("give", "hand"),
    "PUT": ("put", "place", "lay"),
    "TAKE": ("pick", "take", "grasp", "grab"),
}


def _handless(situation: Situation, reading: Reading) -> str:
    """That the robot has no hands, where an order that is asked about needs some."""
    words = {
        word for info in situation.catalogue for word in words_of_name(f"{info.name} {info.description}")
    }
    needed = [wish for wish in reading.wishes if wish.act == "order" and wish.frame in _BY_HAND]
    if not situation.catalogue or not needed or words & {*_BY_HAND[needed[0].frame]}:
        return ""
    return f"I have no hands, so I cannot {needed[0].verb} anything by myself; a person has to help."


def no_facts(told: tuple[Told, ...], situation: Situation, *, beside: bool = False) -> tuple[Told, ...]:
    """The facts of a message, unless it is a stop, an order to go on, a question or an answer."""
    bare = plain(tokenize(situation.message), (situation.robot,))
    kept = tuple(fact for fact in told if fact.is_rule or not facts.is_wish(fact.text))
    kept = tuple(fact for fact in kept if fact.is_rule or not _is_robots_work(fact.text, situation))
    kept = () if facts.is_report(situation.message) else kept
    return kept if kept and facts.worth_keeping(situation, bare, beside=beside) else ()


def _is_robots_work(text: str, situation: Situation) -> bool:
    """Whether it is said what a robot does, and not where it is: "Rex takes bay 2" is an order."""
    first, _, rest = text.partition(" ")
    does = rest.partition(" ")[0].lower()
    deeds = lexicon_of_words().frames_of([does], []) - {"BELOC", "BECAT", "WAIT"} if does[-1:] == "s" else {}
    return bool(deeds) and first.lower() in {name.lower() for name in situation.robots}


_DONE: Final = re.compile(
    r"\b(?:already|done|superfluous|unnecessary|redundant|pointless|can wait|no longer needed|not needed|"
    r"taken care of|(?:somebody|someone) else (?:will|can|does|did|has))\b",
    re.IGNORECASE,
)


def _superfluous(situation: Situation, tokens: Sequence[Token], lexicon: Lexicon) -> Ask | None:
    """Whether to leave out what is planned, where it is told that it is done or need not be done."""
    if _DONE.search(situation.message) is None or situation.message.rstrip().endswith("?"):
        return None
    planned = {thing.id for visit in visits(situation) for thing in visit.things}
    things = named_alone(tokens, situation.objects, lexicon)
    names = [thing.description for thing in things if thing.id in planned]
    if not names:
        return None
    what = f"leave out the {' and the '.join(names)}"
    return Ask(f"Shall I {what}?", (what,))


def _edit(change: Change, situation: Situation, do: Do | None = None) -> Decision:
    if change.question:
        return Ask(change.question, change.choices)
    proposal = situation.dialogue.proposal
    if proposal is None or situation.queue:
        return Edit(change, do, steps=situation.steps)
    gone = set(change.drop)
    kept = tuple(call for visit in visits(situation) if not gone & {*visit.steps} for call in visit.calls)
    return Edit(replace(change, kept=kept), do, proposal.id)


def subject_of(situation: Situation, parts: Sequence[Part], lexicon: Lexicon) -> MapObject | None:
    """The thing of the map with which a message begins to tell of something: "the pump leaks, look at it"."""
    tokens = parts[0].parse.tokens if parts[0].clause.link == "main" else ()
    name = next(iter(named(tokens, situation.objects, lexicon)), None)
    begins = name is not None and name.start < _SUBJECT and parts[0].parse.acts[name.start] in _TELLING
    return name.things[0] if name is not None and begins and len(name.things) == 1 else None


_SUBJECT: Final = 2
_TELLING: Final = frozenset({"told", "need", "alarm"})


def only_names(
    situation: Situation, tokens: Sequence[Token], names: Sequence[Named], lexicon: Lexicon
) -> bool:
    """Whether a message is nothing but one name: "the yard", "ok, then the yard please"."""
    if len(names) != 1 or situation.message.rstrip().endswith("?") or situation.dialogue.proposal is not None:
        return False
    small = lexicon.classes["small"] | lexicon.classes["determiners"] | _LEADING_ON
    called = {word for name in situation.robots for word in name.lower().split()}
    rest = {token.low for at, token in enumerate(tokens) if not names[0].start <= at < names[0].end}
    return all(word in small or word in called or not word[0].isalnum() for word in rest)


_LEADING_ON: Final = word_set("and then now next also ok okay great good fine thanks to first")


# -- what was spoken of -------------------------------------------------------------------------------


def spoken_of(
    situation: Situation, known: Sequence[Place], lexicon: Lexicon, *, sought: bool = False
) -> tuple[MapObject | Place | None, Place | None]:
    """What "it", "there" and "her" mean when a message begins: what was named last, who was told of last.

    What is `sought` is not the place by which something was that nobody knows: "I had it by the gate".
    """
    calls = {order.words: order.calls for order in situation.dialogue.orders}
    if (waits := situation.dialogue.proposal) is not None:
        calls[waits.words] = waits.steps
    thing: MapObject | Place | None = _found(situation)
    place: MapObject | Place | None = None
    person: Place | None = None
    open_ = False
    for turn in reversed(situation.history[-_TURNS:]):
        if turn.role != "operator":
            continue
        texts = [words for call in calls.get(turn.content, ()) for words in texts_of(call)]
        tokens = tokenize(turn.content)
        low, names = {token.low for token in tokens}, named(tokens, situation.objects, lexicon)
        if person is None:
            person = next((p for p in known if _is_called(p) and {*p.thing.lower().split()} <= low), None)
        if thing is None and not open_:  # "my book is on the desk" speaks of the book
            bare = not names
            thing = next(
                (p for p in known if not _is_called(p) and _tells_of(p, turn.content, low, bare)), None
            )
        spot = tokens[:1] and tokens[0].low in _AT  # "on the desk" is where something else is
        its = next((at for at, token in enumerate(tokens) if token.low in _IT), len(tokens))
        told = bool(texts) and names and names[-1].end <= its < len(tokens)  # "the crate next to it"
        if (_IT & low or spot) and names and not told:  # "bring it to the gate" speaks of no gate
            place = place or names[-1].things[0]
        elif thing is None and not open_:
            most = most_asked(tokens, situation, lexicon)
            found = most[0] if len(most) == 1 else None
            found = found or _thing_in([*reversed(texts), turn.content], low, situation, lexicon)
            open_ = found is None and len(names) == 1 and len(names[0].things) > 1  # "are there any crates?"
            if "there" in low and not names:
                place = place or found  # "go there" brings up nothing new
            else:
                thing = found
    return thing or (None if sought else place), person


_IT: Final = frozenset({"it", "them", "one"})
_AT: Final = frozenset({"on", "in", "at", "by", "near", "under", "behind"})


def _tells_of(place: Place, text: str, low: set[str], bare: bool) -> bool:
    """Whether words told where a thing is, or `bare` of things of the map name it."""
    return place.memory.data.lower() in text.lower() or (bare and {*place.thing.lower().split()} <= low)


def _found(situation: Situation) -> MapObject | None:
    """What the robot has just found and asks about."""
    found = situation.failure.details.get("found") if situation.failure is not None else None
    names = found if isinstance(found, list) else []
    things = [item for item in situation.objects if item.description in names]
    return things[0] if len(things) == 1 else None


def _is_called(place: Place) -> bool:
    """Whether what is remembered to be somewhere has a name of its own, as people have."""
    words = place.thing.split(" ")
    return words[0].capitalize() in re.findall(r"\w+", place.memory.data) and "'s" not in words


def _thing_in(
    texts: Sequence[str], low: set[str], situation: Situation, lexicon: Lexicon
) -> MapObject | None:
    for text in texts:
        if single := named_alone(tokenize(text), situation.objects, lexicon):
            return single[-1]
    if spaces := [room for room in situation.rooms if {*room.description.lower().split()} <= low]:
        return spaces[-1]
    room = next((room for room in rooms(situation.objects) if set(room.split()) <= low), "")
    inside = in_room(room, situation.objects, situation.robot_pose) if room else ()
    return inside[0] if inside else None
