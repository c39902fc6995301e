"""What to do when a step failed, and what of an answer settles it; all else is left to the chat."""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Final

from parley.errors import FailureCode
from parley.gate.control import control_of
from parley.language.base import ErrorSituation, Situation
from parley.language.builtin.decision import Ask, Decision, Do
from parley.language.builtin.facts import Place, known_place, places
from parley.language.builtin.lexicon import Lexicon, stem
from parley.language.builtin.reading import Reading
from parley.language.builtin.reply import said as words_for
from parley.language.builtin.reply import to_chat
from parley.language.builtin.saying import listed, with_article
from parley.language.builtin.things import head_of, link, noun_phrase
from parley.language.builtin.tokens import tokenize
from parley.language.dialogue.answers import differences
from parley.language.dialogue.map_words import named_alone, rooms
from parley.language.dialogue.questions import asks, plain, question_of
from parley.language.dialogue.replies import Settled, chosen, names_deed, parts_of, settled, words_of
from parley.language.dialogue.standing import read_rule
from parley.language.lexicon import word_set
from parley.messages.chat import ActionCall, ChatAction, SystemCommand
from parley.messages.memory import MemoryEntry
from parley.world.object_map import MapObject

__all__ = ["Repairer"]

_AGAIN, _WITHOUT, _STOP = "try again", "go on without it", "stop"
_ON, _LOOK_AGAIN = "go on", "look again"
_YES: Final = frozenset({"yes", "yeah", "ok", "okay", "sure", "yep", "please", "do", "it", "that"})
_LONGEST: Final = 12
"""So many words an answer has at most that only names a thing."""
_HELPED: Final = frozenset({FailureCode.NOT_CAPABLE, FailureCode.DECLINED, FailureCode.NOT_UNDERSTOOD})
"""Failures after which a person does the step: when they have done it, it is over."""
_ON_THE_WAY: Final = frozenset({FailureCode.UNREACHABLE, FailureCode.BLOCKED, FailureCode.TIMED_OUT})
"""Failures after which another place may be named."""
_NOT_UNDERSTOOD: Final = "understand"
_CODE_WORDS: Final = {
    FailureCode.NO_MATCH: "find see there missing unknown gone", FailureCode.AMBIGUOUS: "several which sure",
    FailureCode.UNREACHABLE: "reach way closed shut locked",
    FailureCode.BLOCKED: "blocked block way stuck obstacle", FailureCode.TIMED_OUT: "long late slow time",
    FailureCode.UNAVAILABLE: "answer available", FailureCode.NOT_CAPABLE: "able can't cannot",
    FailureCode.HARDWARE: "broken work fail",
}  # fmt: skip
"""How people speak of a failure when they teach what is to be done about it."""
_ANY_FAILURE: Final = "fail failed wrong error trouble problem something anything step goes go"


@dataclass(frozen=True, slots=True)
class Repairer:
    """Repairs a failed step by what was taught, what is remembered, or what a person answers."""

    lexicon: Lexicon
    decide: Callable[[Situation], Decision]
    reading: Callable[[str], Reading]

    def resolve(self, situation: ErrorSituation) -> ChatAction:
        """See `Language.resolve`; an empty answer leaves what was said to the chat."""
        names = _candidates(situation)
        if situation.reply is None:
            return self._alone(situation) or _ask(situation, names)
        if not any(token.is_word for token in tokenize(situation.reply)):
            return ChatAction(message_response="I cannot see what is in a picture. Please tell me in words.")
        return self._answered(situation, situation.reply, names) or self._left(situation, names)

    # -- without asking --------------------------------------------------------------------------------

    def _alone(self, situation: ErrorSituation) -> ChatAction | None:
        """What was taught for such a failure, else another place that is remembered; nothing twice."""
        taught = (self._taught(entry, situation) for entry in reversed(situation.memory))
        found = [one for one in (*taught, self._remembered(situation)) if one is not None]
        return next((one for one in found if not _is_tried(situation, one)), None)

    def _taught(self, rule: MemoryEntry, situation: ErrorSituation) -> ChatAction | None:
        """For "when the way is blocked, wait a minute and try again": an answer that was given beforehand."""
        read = read_rule(rule.data) if rule.type == "text" else None
        if read is None or not self._is_case(read.case, situation):
            return None
        what = " and ".join(act.words for act in read.acts)
        made = self._answered(situation, what, ()) or self._ordered(situation, what)
        if made is None or not made.success:
            return None
        text = f"{situation.error_message.strip()} You told me: “{rule.data.rstrip('.')}”. I do so now."
        return made.model_copy(update={"message_response": text, "sources": (rule.name,)})

    def _is_case(self, case: Sequence[str], situation: ErrorSituation) -> bool:
        """Whether a failure is what a rule is for: every word of its condition is about it."""
        small = self.lexicon.classes["small"] | self.lexicon.classes["determiners"]
        small = small | self.lexicon.classes["prepositions"] | self.lexicon.classes["being"] | {"you", "be"}
        words = {stem(word) for word in case if word[0].isalnum() and word not in small}
        kind = _stems(_CODE_WORDS.get(situation.code, ""))
        about = kind | _stems(
            f"{_ANY_FAILURE} {situation.error_message} {_words_of(situation.failed_action)}"
        )
        telling = kind | _stems(f"fail failed wrong error problem {situation.error_message}")
        return bool(words) and words <= about and bool(words & telling)

    def _remembered(self, situation: ErrorSituation) -> ChatAction | None:
        """Something is not where the robot looked, and is remembered to be somewhere else."""
        known = places(situation.memory, self.reading, self.lexicon)
        words = words_of(_words_of(situation.failed_action))
        if situation.code is not FailureCode.NO_MATCH or not words:
            return None
        name, _ = noun_phrase(words, head_of(words, self.lexicon), self.lexicon)
        place = known_place(name, known)
        made = self._at_place(situation, place) if place is not None else None
        if place is None or made is None:
            return None
        text = f"I remember: {place.memory.data.rstrip('.')}. {made.message_response}"
        return made.model_copy(update={"message_response": text, "sources": (place.memory.name,)})

    def _at_place(self, situation: ErrorSituation, place: Place) -> ChatAction | None:
        """The failed step at another place: a look there, or that place instead of a word no map knows."""
        where = link(place.where, place.head, situation.objects, self.lexicon)
        if where.kind != "one":
            return None
        text = with_article(where.things[0].description)
        if not _looks(situation) and not _words_of(situation.failed_action):
            way = self._ordered(situation, f"go to {text}")
            return _solved(situation, f"I go to {text} instead.", way.queue) if way is not None else None
        if not _looks(situation):
            step = _with_words(situation.failed_action, where.things[0].description)
            return _solved(situation, f"I take {text}.", (step,))
        last = next((_words_of(step) for step in reversed(situation.completed) if _words_of(step)), "")
        way = self._ordered(situation, f"go to {text}")
        if way is None or last == where.things[0].description:
            return None
        return _solved(situation, f"I go to {text} and look there.", (*way.queue, situation.failed_action))

    # -- by an answer ----------------------------------------------------------------------------------

    def _answered(self, situation: ErrorSituation, reply: str, names: Sequence[str]) -> ChatAction | None:
        """What settles the failure; None if nothing of it does."""
        if reply.rstrip().endswith("?") and asks(reply, plain(tokenize(reply))) and not _is_wish(reply):
            return None
        chose = self._chosen(situation, reply, names) or self._pursued(situation, reply)
        if chose is not None:
            return chose
        found = settled(
            reply,
            self._other_things(situation),
            in_the_way=situation.code in (*_ON_THE_WAY, FailureCode.ATTENTION),
        )
        if found is not None:
            return self._settled(situation, found)
        words = words_of(reply)
        if {*words} <= _YES and not names:
            return _solved(situation, "I try again.", (situation.failed_action,))
        return self._elsewhere(situation, reply)

    def _chosen(self, situation: ErrorSituation, reply: str, names: Sequence[str]) -> ChatAction | None:
        """One of several things, and perhaps an order behind it."""
        also = {item.description: item.aliases for item in situation.objects}
        for piece, rest in [next(parts_of(reply)), (reply, "")] if names else []:
            words = words_of(piece)
            choice = chosen(words, names, also)
            ordered = self._ordered(situation, rest) if rest else None
            if choice is None or len(words) > _LONGEST or (rest and ordered is None):
                continue
            if names_deed(words) and not _goes_there(situation, words, choice):
                continue
            step = _with_words(situation.failed_action, choice)
            return _with_rest(_solved(situation, f"Thank you. I take the {choice}.", (step,)), ordered)
        return None

    def _pursued(self, situation: ErrorSituation, reply: str) -> ChatAction | None:
        """What is to be done about something that was found; then the plan goes on."""
        if situation.code is not FailureCode.ATTENTION:
            return None
        told = settled(reply, ())
        if control_of(reply) == "start" and (told is None or told.way != "again"):
            return _solved(situation, "I go on.", ())
        found = situation.details.get("found")
        made = (
            self.decide(replace(_as_message(situation, reply), failure=situation))
            if isinstance(found, list)
            else None
        )
        if not isinstance(made, Do) or not isinstance(found, list):
            return None
        given = [value for deed in made.deeds for value in deed.arguments.values()]
        about = any(isinstance(value, str) and value in found for value in given)
        return (
            _solved(situation, f"I will {self._listed(made)}.", to_chat(made, self.lexicon).queue)
            if about
            else None
        )

    def _settled(self, situation: ErrorSituation, found: Settled) -> ChatAction | None:
        behind = self._ordered(situation, found.rest) if found.rest else None
        unclear = behind is None and any(
            wish.act == "order" for wish in self.reading(found.rest or "-").wishes
        )
        again = (situation.failed_action,)
        if found.delay_s:
            waits = _solved(situation, "All right, I wait and then try again.", again)
            return waits.model_copy(update={"delay_s": found.delay_s})
        match found.way:
            case "stop":
                made = _solved(situation, "I stop here.", (), (SystemCommand(command="stop"),))
            case "clear":
                return None if unclear else self._given_up(situation, found.rest, behind)
            case "promise":
                made = ChatAction(message_response="All right, I wait. Please tell me when it is done.")
            case "without":
                made = _solved(situation, "I go on without it.", ())
            case "done" if situation.code is FailureCode.NO_MATCH and control_of(situation.reply or ""):
                made = _solved(situation, "I go on without it.", ())  # "go on": nobody has helped
            case "done":
                over = situation.code in _HELPED
                said = "I try again." if situation.code is FailureCode.FORBIDDEN else "Thank you. I go on."
                made = _solved(situation, said, () if over else again)
            case _:
                made = _solved(situation, "I try again.", again)
        if unclear:
            text = f"{made.message_response} I did not understand “{found.rest}”."
            made = made.model_copy(update={"message_response": text})
        return _with_fact(_with_rest(made, behind), found.fact)

    @staticmethod
    def _given_up(situation: ErrorSituation, rest: str, behind: ChatAction | None) -> ChatAction:
        """Without the step where nothing is wanted instead; else that in place of the whole plan."""
        if rest and behind is None:
            return _solved(situation, "I go on without it.", ())
        more = f" {behind.message_response}" if behind is not None else ""
        steps, drops = behind.queue if behind is not None else (), (SystemCommand(command="clear"),)
        return _solved(situation, f"I drop the rest of my plan.{more}", steps, drops)

    def _elsewhere(self, situation: ErrorSituation, reply: str) -> ChatAction | None:
        """Where a thing is that was not found, or which other one is meant."""
        sought = situation.code in (FailureCode.NO_MATCH, FailureCode.AMBIGUOUS)
        other = situation.code in _ON_THE_WAY and not {"look", "check", "inspect"} & {*words_of(reply)}
        if not sought and (_looks(situation) or not other):
            return None
        said = MemoryEntry(name="told", data=reply)
        told = places([said], self.reading, self.lexicon) if sought else []
        about = _stems(_words_of(situation.failed_action)) | {"it", "he", "she", "they", "that", "this"}
        for place in told:
            if {stem(word) for word in place.thing.split()} <= about:
                return self._kept(situation, reply, self._at_place(situation, place))
        tokens = tokenize(reply)
        things = named_alone(tokens, situation.objects, self.lexicon)
        things = things or self._lettered(situation, [token.text for token in tokens])
        if len(things) != 1 or len(words_of(reply)) > _LONGEST or not self._only_names(reply, things[0]):
            return None
        words = tuple(things[0].description.lower().split())
        return self._at_place(situation, Place("it", words, head_of(words, self.lexicon), said))

    @staticmethod
    def _lettered(situation: ErrorSituation, said: Sequence[str]) -> list[MapObject]:
        """What is called as the place of the step, but for a letter or number: "try B" of bays A and B."""
        last = next((_words_of(step) for step in reversed(situation.completed) if _words_of(step)), "")
        own, marks = last.lower().split(), {word for word in said if len(word) == 1 and word.isalnum()}
        names = {tuple(mark.lower() if len(word) == 1 else word for word in own) for mark in marks}
        return [
            one for one in situation.objects if tuple(one.description.lower().split()) in names - {(*own,)}
        ]

    def _kept(self, situation: ErrorSituation, reply: str, made: ChatAction | None) -> ChatAction | None:
        """With a memory of where the thing is that was not found."""
        words = words_of(_words_of(situation.failed_action))
        wish = next((wish for wish in self.reading(reply).wishes if wish.frame == "BELOC"), None)
        where = (wish.one("L") or wish.one("G")) if wish is not None else None
        if made is None or where is None or not words:
            return made
        name, _ = noun_phrase(words, head_of(words, self.lexicon), self.lexicon)
        thing = " ".join(name)
        fact = {"name": f"{'_'.join(name)}_location", "data": f"{with_article(thing)} is {where.text}",
                "info": f"Where {with_article(thing)} is"}  # fmt: skip
        return made.model_copy(
            update={"system_cmd": (SystemCommand(command="add_memory", arguments=dict(fact)),)}
        )

    def _only_names(self, reply: str, thing: MapObject) -> bool:
        """Whether an answer only names a thing, or orders the failed step with it: "try the desk"."""
        own = _stems(" ".join((thing.description, *thing.aliases)))
        small = self.lexicon.classes["small"] | self.lexicon.classes["prepositions"] | _NAMING
        small = small | self.lexicon.classes["determiners"]
        return all(word in small or stem(word) in own for word in words_of(reply))

    def _ordered(self, situation: ErrorSituation, words: str) -> ChatAction | None:
        """The steps of an order that is said besides, if it is certain."""
        made = self.decide(_as_message(situation, words))
        if not isinstance(made, Do):
            return None
        chat = to_chat(made, self.lexicon)
        return chat.model_copy(update={"message_response": f"I will {self._listed(made)}."})

    def _listed(self, made: Do) -> str:
        return listed([words_for(deed, self.lexicon) for deed in made.deeds if not deed.hidden])

    def _other_things(self, situation: ErrorSituation) -> set[str]:
        """The words for things and rooms that the failed step is not about."""
        small = self.lexicon.classes["prepositions"] | self.lexicon.classes["determiners"]
        step = f"{_words_of(situation.failed_action)} {situation.failed_action.reason}".lower()
        called = [" ".join((item.description, *item.aliases)) for item in situation.objects]
        own = [text for text, item in zip(called, situation.objects, strict=True) if item.description in step]
        known = _stems(" ".join([*called, *rooms(situation.objects)]))
        return known - _stems(" ".join([step, *own])) - {stem(word) for word in small}

    def _left(self, situation: ErrorSituation, names: Sequence[str]) -> ChatAction:
        """Nothing, if the chat has something to say to an answer; else the question once more."""
        message = _as_message(situation, situation.reply or "")
        made = self.decide(replace(message, question=_question(situation, names)[0]))
        reading = self.reading(situation.reply or "")
        meant = any(wish.act == "order" and wish.witness == "agrees" for wish in reading.wishes)
        planned = _stems(" ".join(f"{_words_of(step)} {step.reason}" for step in situation.pending))
        meant = meant or bool(self._other_things(situation) & planned & _stems(situation.reply or ""))
        if not isinstance(made, Ask) or made.choices or made.offer or made.alarms or meant:
            return _about_candidates(situation, names) or ChatAction()
        question, choices = _question(situation, names)
        still = any(
            _NOT_UNDERSTOOD in turn.content for turn in situation.dialogue if turn.role == "assistant"
        )
        lead = "I still do not understand you." if still else "I did not understand that."
        return ChatAction(success=False, message_response=f"{lead} {question}", choices=choices)


_NAMING: Final = word_set("""i mean meant is it he she they take use try go for drive yes no sorry please
instead rather choose pick look check then maybe think should be""")
"""What may stand with the name of a thing in an answer that only names it."""


def _about_candidates(situation: ErrorSituation, names: Sequence[str]) -> ChatAction | None:
    question = question_of(plain(tokenize(situation.reply or ""))) if names else None
    if question is None or question.topic != "difference":
        return None
    return ChatAction(message_response=differences(names, situation.objects))


def _is_wish(reply: str) -> bool:
    """Whether a question is how an answer is put: "can you try again?", "why don't you go around it?"."""
    return re.match(r"\W*(?:can|could|will|would|why (?:don['’]t|not))\b", reply.lower()) is not None


def _stems(text: str) -> set[str]:
    return {stem(word) for word in words_of(text)}


def _words_of(step: ActionCall) -> str:
    """The words that a step is given first."""
    values = (
        item.value for item in step.input_parameters.values() if item.type == "string" and item.has_data
    )
    return str(next(values, ""))


def _looks(situation: ErrorSituation) -> bool:
    """Whether the failed step looks at something, or for what it takes."""
    infos = (info for info in situation.catalogue if info.name == situation.failed_action.name)
    return any({"looks", "grasps"} & {*info.effects} for info in infos)


def _is_tried(situation: ErrorSituation, repair: ChatAction) -> bool:
    wanted = [(step.name, _words_of(step)) for step in repair.queue]
    tried = ([(step.name, _words_of(step)) for step in steps] for steps in situation.tried)
    return bool(wanted) and wanted in list(tried)


def _as_message(situation: ErrorSituation, words: str) -> Situation:
    """What is known about a failure, for understanding words as a message of their own."""
    return Situation(
        words,
        memory=situation.memory,
        objects=situation.objects,
        robot_pose=situation.robot_pose,
        robot=situation.robot,
        robots=(situation.robot,) if situation.robot else (),
        catalogue=situation.catalogue,
    )


_GOING: Final = word_set("go drive come move over to the please now then just")


def _goes_there(situation: ErrorSituation, words: Sequence[str], choice: str) -> bool:
    """Whether somebody orders just what the search that failed was made for: "go to the north gate"."""
    infos = (info for info in situation.catalogue if info.name == situation.failed_action.name)
    finds = next((info.only_finds for info in infos), False)
    return finds and {*words} <= _GOING | {*choice.lower().split()}


def _candidates(situation: ErrorSituation) -> tuple[str, ...]:
    listed_ = situation.details.get("candidates")
    if situation.code is not FailureCode.AMBIGUOUS or not isinstance(listed_, list):
        return ()
    return tuple(
        str(item["description"]) for item in listed_ if isinstance(item, dict) and "description" in item
    )


def _question(situation: ErrorSituation, names: Sequence[str]) -> tuple[str, tuple[str, ...]]:
    """What is asked about a failure, and what is offered."""
    if names:
        shown = listed([f"the {name}" for name in names])
        return f"I know {len(names)} things that fit: {shown}. Which one do you mean?", tuple(names)
    text = situation.error_message.strip() or "A step did not work."
    if situation.code is FailureCode.ATTENTION:
        return f"{text} I have stopped here. What shall I do: {_ON}, {_LOOK_AGAIN}, or {_STOP}?", (
            _ON,
            _LOOK_AGAIN,
            _STOP,
        )
    return f"{text} Shall I {_AGAIN}, {_WITHOUT}, or {_STOP}?", (_AGAIN, _WITHOUT, _STOP)


def _ask(situation: ErrorSituation, names: Sequence[str]) -> ChatAction:
    question, choices = _question(situation, names)
    lead = "That did not help. " if situation.tried and situation.code is not FailureCode.ATTENTION else ""
    return ChatAction(success=False, message_response=f"{lead}{question}", choices=choices)


def _solved(
    situation: ErrorSituation, text: str, steps: Sequence[ActionCall], commands: Sequence[SystemCommand] = ()
) -> ChatAction:
    targets = (situation.robot,) if situation.robot else ()
    return ChatAction(
        success=True, message_response=text, queue=tuple(steps), system_cmd=tuple(commands), targets=targets
    )


def _with_rest(made: ChatAction, behind: ChatAction | None) -> ChatAction:
    """With an order that comes after the rest of the plan."""
    if behind is None:
        return made
    text = f"{made.message_response} After that: {behind.message_response}"
    return made.model_copy(update={"message_response": text, "afterwards": behind.queue})


def _with_fact(made: ChatAction, fact: str) -> ChatAction:
    """With a memory of what was told."""
    if not fact:
        return made
    name = "_".join(re.findall(r"\w+", fact.lower()))[:150]
    kept = SystemCommand(command="add_memory", arguments={"name": name, "data": fact, "info": fact})
    return made.model_copy(update={"system_cmd": (*made.system_cmd, kept)})


def _with_words(step: ActionCall, words: str) -> ActionCall:
    inputs = dict(step.input_parameters)
    for name, parameter in inputs.items():
        if parameter.type == "string":
            inputs[name] = replace(parameter, value=words)
            break
    return step.model_copy(update={"input_parameters": inputs})
