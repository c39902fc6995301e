"""Talking about rules: told, asked about, dropped; each change counts after a person's yes."""

from __future__ import annotations

import re
import uuid
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Final

from parley.errors import ConfigError
from parley.gate.assent import assent_of
from parley.gate.book import RuleBook
from parley.gate.rules import RuleKeeper
from parley.gate.table import Effect, verdict
from parley.gate.told import DraftRule, NotUnderstood, lifted_place, named_place, told_rule
from parley.gate.wording import rule_text
from parley.latest import Latest
from parley.messages.principal import Principal
from parley.messages.rules import Rule
from parley.messages.status import ActionInfo
from parley.sentences import LANGUAGES, in_language, listed, sentence, together
from parley.world.object_map import MapArea, MapObject

__all__ = ["Listener", "RuleConfirmations", "RuleReply", "RuleTalk", "left_over_rule"]

_KEPT: Final = 100
_SHORT: Final = 2
"""So many words are meant as an answer, even if they fit no choice."""
_YES: Final = frozenset({"yes", "y", "ok", "okay", "sure", "yes please", "jah", "ja", "jaa", "olgu"})
_NO: Final = frozenset({"no", "n", "nope", "no thanks", "never mind", "ei", "ära"})
_LIST: Final = re.compile(
    r"^(?:what|which)(?: are the| are your)? rules(?: are there| hold| do you have| are in force)?$"
    r"|^(?:list|show|tell)(?: me)?(?: all)?(?: the| your)? rules$"
    r"|^(?:what|where)(?: must| may| can| should| are)(?: you not|n't you| you never| you not allowed to)"
    r"(?: do| go| drive)?$|^what(?: are you| is) (?:not allowed|forbidden)(?: to do)?$"
    r"|^(?:mis|millised) reeglid(?: on| kehtivad| sul on)?$"
)
_DROP: Final = re.compile(
    r"^(?:(?:please|ok|okay|no|well|so|then|and|actually),? )*"
    r"(?:drop|delete|remove|forget|lift|cancel) (?:the|that|this|those|your)(?: last| new)? "
    r"rules?"
    r"(?: (?:about|on|for|that) (?P<about>.+))?$"
    r"|^(?:palun )?(?:kustuta|tühista|unusta) reegel(?: (?P<kohta>.+?)(?: kohta)?)?$"
)


_INSIST: Final = re.compile(
    r"\b(?:anyway|anyhow|all the same|regardless|nevertheless|nonetheless|even so|ikka|ikkagi|siiski)\b"
    r"|\b(?:ignore|override|overrule|disregard|break|bypass|eira) (?:(?:the|that|this|your|seda) )?"
    r"(?:rules?|reeglit)\b"
)
_NO_NAME: Final = frozenset({"in", "inside", "there", "it", "again", "now", "back", "sinna", "sisse"})
_KINDS: Final = frozenset({"area", "zone", "room", "bay"})
"""Of "area B" people say "B"."""
_NAMES_NOTHING: Final = frozenset({
    "yes", "no", "but", "ok", "okay", "well", "just", "please", "then", "still", "you", "i", "say",
    "said", "can", "may", "do", "go", "drive", "move", "try", "proceed", "carry", "on", "in",
    "into", "through", "ahead", "and", "it", "that", "so", "there", "now", "once", "this", "time",
    "anyway", "anyhow", "all", "the", "same", "regardless", "nevertheless", "nonetheless", "even",
    "ignore", "override", "overrule", "disregard", "break", "bypass", "your", "rule", "rules",
    "ikka", "ikkagi", "siiski", "tee", "mine", "sõida", "palun", "sinna", "seda", "aga", "jah",
    "eira", "reeglit",
})  # fmt: skip
"""Of such words is made what wants just what was refused."""


@dataclass(frozen=True, slots=True)
class Listener:
    """The robot that is spoken to, and what words about rules can mean to it."""

    robot: str
    robots: Sequence[str]
    """All robots."""
    places: Sequence[MapObject] = ()
    """What is on the map."""
    catalogue: Sequence[ActionInfo] = ()
    """What it can do."""
    busy: bool = True
    """Whether it has something to do: then "don't go there" is about that."""
    doing: str = ""
    """What that is in words, if it is known."""
    there: str = ""
    """The place that it was sent to last."""


@dataclass(frozen=True, slots=True)
class RuleReply:
    """What is said to the person."""

    text: str
    id: str = ""
    """Of a question; empty: nothing is asked."""
    choices: tuple[str, ...] = ()
    closes: str = ""
    """The question that is settled by it."""
    stands: tuple[str, ...] = ()
    """Robots that stand still while it is open, so that nothing happens that the answer would forbid."""
    rules: tuple[Rule, ...] = ()
    """What a yes would make rules."""


@dataclass(frozen=True, slots=True)
class _Pending:
    """A change that waits for a yes: what each choice would put in force, or drop."""

    text: str
    choices: tuple[tuple[str, Rule], ...]
    robot: str
    drops: bool = False
    stands: tuple[str, ...] = ()

    @property
    def shown(self) -> Rule | None:
        """What a plain yes means: what the question says, or the only choice."""
        return None if self.drops and len(self.choices) > 1 else self.choices[0][1]


class RuleConfirmations:
    """Changes of rules that wait for a person's yes, by the question about them."""

    def __init__(self) -> None:
        self._waiting: Latest[str, _Pending] = Latest(_KEPT)

    def asked(self, question: str) -> bool:
        """Whether this question is one of ours."""
        return question in self._waiting

    def of(self, robot: str) -> tuple[str, str]:
        """The question for whose answer a robot stands, and who asks it; empty if there is none."""
        found = ((key, item.robot) for key, item in self._waiting.items() if robot in item.stands)
        return next(found, ("", ""))

    def about(self, rule: Rule) -> tuple[str, str]:
        """The question about making a rule, and the robot that asks it; empty if nobody asks."""
        for question, pending in self._waiting.items():
            if not pending.drops and _same(pending.choices[0][1], rule):
                return question, pending.robot
        return "", ""

    def closing(self, rules: Sequence[Rule]) -> str:
        """A question whether to close what such rules close; empty if there is none."""
        return next((key for key, item in self._waiting.items() if item.choices[0][1] in rules), "")

    @property
    def proposed(self) -> tuple[Rule, ...]:
        """What a yes would make a rule."""
        return tuple(item.choices[0][1] for item in self._waiting.values() if not item.drops)

    def put(
        self, text: str, rules: Sequence[Rule], robot: str, *, drops: bool = False, stands: Sequence[str] = ()
    ) -> RuleReply:
        """Ask about a change, or which rule to drop; of several to make, the text says the first."""
        labels = [sentence("yes") if len(rules) == 1 else rule_text(rule) for rule in rules]
        choices = tuple(zip(labels, rules, strict=True))
        return self._asked(_Pending(text, choices, robot, drops, tuple(stands)))

    def again(self, question: str, text: str = "") -> RuleReply:
        """Ask once more what was not answered, perhaps in other words."""
        return replace(self._asked(self._waiting.pop(question), text), closes=question)

    def explained(self, question: str) -> RuleReply:
        """Ask once more, for somebody who asks back ("why not?")."""
        asked = self._waiting[question].text
        why = "It was said to me as a rule, and a rule counts only with a yes. {asked}"
        return self.again(question, sentence(why, asked=asked))

    def withdraw(self, question: str) -> None:
        """Ask no more."""
        self._waiting.pop(question, None)

    def _asked(self, pending: _Pending, text: str = "") -> RuleReply:
        question = uuid.uuid4().hex
        self._waiting[question] = pending
        choices = (*(label for label, _ in pending.choices), sentence("no"))
        rules = () if pending.drops else tuple(rule for _, rule in pending.choices)
        return RuleReply(text or pending.text, question, choices, stands=pending.stands, rules=rules)

    def answered(self, question: str, text: str) -> tuple[Rule | None, bool] | None:
        """The rule that was said yes to (None after a no), and whether it is to be dropped; None: unclear."""
        pending, said = self._waiting.get(question), _plain(text)
        if pending is None:
            return None
        chosen = next((rule for label, rule in pending.choices if said in _forms(label)), None)
        if chosen is None and said.isdigit() and 0 < int(said) <= len(pending.choices):
            chosen = pending.choices[int(said) - 1][1]
        literal = True if said in _YES else False if said in _NO else assent_of(text)
        if chosen is None and literal:
            chosen = pending.shown
        if chosen is None and literal is not False:
            return None
        del self._waiting[question]
        return chosen, pending.drops


def _plain(text: str) -> str:
    return re.sub(r"\s+", " ", text).casefold().strip(" .!")


def _forms(label: str) -> set[str]:
    return {_plain(in_language(label, language)) for language in LANGUAGES}


class RuleTalk:
    """What the chat asks about rules before any language engine sees a message.

    Args:
        book: The rules in force.
        keeper: Where they are kept.
        areas: Gives rooms and other named parts of the map.
    """

    def __init__(
        self, book: RuleBook, keeper: RuleKeeper, areas: Callable[[], Sequence[MapArea]] = tuple
    ) -> None:
        self._book, self._keeper, self._areas = book, keeper, areas
        self._confirmations = RuleConfirmations()
        self._refused: Latest[str, tuple[str, ...]] = Latest()
        """By which rules what a robot was told last was refused."""

    @property
    def has_rules(self) -> bool:
        """Whether any rule is in force."""
        return self._book.has_rules

    def asked(self, question: str) -> bool:
        """Whether this question is one of ours."""
        return self._confirmations.asked(question)

    def concerns(self, text: str, to: Listener) -> bool:
        """Whether words are about rules, whatever else is asked at the moment."""
        said = _plain(text).rstrip("?")
        return bool(
            _LIST.match(said)
            or _DROP.match(said)
            or self._closing(self._freed(text, to), self._all)
            or self._told(text, to) is not None
            or self._insisted(said, to.robot)
        )

    async def reply(self, text: str, by: Principal, to: Listener, *, answers: str = "") -> RuleReply | None:
        """What to say to a message that is about rules; None for every other message.

        Args:
            text: What was said.
            by: Who says it.
            to: Who is spoken to.
            answers: The question that it answers, if it does.
        """
        reply = await self._reply(text, by, to, answers)
        await self._keeper.note_asked(self._confirmations.proposed)
        return reply

    async def _reply(self, text: str, by: Principal, to: Listener, answers: str) -> RuleReply | None:
        if answers and self.asked(answers):
            reply = await self._answer(answers, text, by)
            if reply is not None:
                return reply
        said = _plain(text).rstrip("?")
        if _LIST.match(said):
            return RuleReply(self._listed())
        if found := _DROP.match(said):
            waits = self._confirmations.closing(self._confirmations.proposed)
            if waits and not (found["about"] or found["kohta"]):  # it is no rule yet
                return await self._answer(waits, "no", by)
            return self._drop(found["about"] or found["kohta"] or "", by, to)
        if (place := self._freed(text, to)) and (lifted := self._lift(place, by, to)) is not None:
            return lifted
        told = self._told(text, to)
        if told is None and (refused := self._insisted(said, to.robot)):
            return RuleReply(_insisted_text(refused))
        if told is None:
            return None
        if not _may(by):
            return RuleReply(sentence("You may not change rules."))
        if isinstance(told, NotUnderstood):
            return RuleReply(told.sentence)
        return self._proposed(told, to)

    def refused(self, robot: str, rules: Sequence[str]) -> None:
        """Hear by which rules what a robot was told is refused; by none, if it is done."""
        self._refused[robot] = tuple(rules)

    def _insisted(self, said: str, robot: str) -> list[Rule]:
        """The rules past which somebody wants to go."""
        if not _INSIST.search(said) or not set(re.findall(r"\w+", said)) <= _NAMES_NOTHING:
            return []
        found = (self._book.rules.get(name) for name in self._refused.get(robot, ()))
        return [rule for rule in found if rule is not None]

    def again(self, robot: str) -> RuleReply | None:
        """The question for whose answer a robot stands, once more; None if there is none."""
        question, asks = self._confirmations.of(robot)
        if question and asks != robot:
            return RuleReply(sentence("I will not drive before {robot} is told about the rule.", robot=asks))
        return self._confirmations.again(question) if question else None

    def stands(self, robot: str) -> bool:
        """Whether a robot stands until what it has asked about a rule is answered."""
        return self._confirmations.of(robot)[1] == robot

    def left(self, question: str) -> RuleReply | None:
        """A question to which something else was said, once more; None if it is none of ours, or settled."""
        return self._confirmations.again(question) if self.asked(question) else None

    @property
    def _all(self) -> tuple[Rule, ...]:
        """The rules, and what is asked about."""
        return (*self._book.rules.rules, *self._confirmations.proposed)

    def _told(self, text: str, to: Listener) -> DraftRule | NotUnderstood | None:
        return told_rule(
            named_place(text, to.there), places=to.places, catalogue=to.catalogue, robots=to.robots,
            robot=to.robot, busy=to.busy, doing=to.doing, zones=self._book.rules.rules, areas=self._areas(),
        )  # fmt: skip

    def _proposed(self, told: DraftRule, to: Listener) -> RuleReply:
        meant = (told.rule, *told.others)
        known = next((rule for rule in self._book.rules.rules if any(_same(rule, x) for x in meant)), None)
        if known is not None:
            return RuleReply(sentence("That is already a rule: {rule}", rule=rule_text(known)))
        question, robot = self._confirmations.about(told.rule)
        if question and robot == to.robot:
            return self._confirmations.again(question)
        if question:
            return RuleReply(sentence("{robot} asks you about this rule already.", robot=robot))
        stands: Sequence[str] = ()
        if told.rule.kind == "keep_out":  # nobody shall be where the yes would have closed it meanwhile
            stands = told.rule.robots or to.robots
        shown = together(
            sentence("I understand this as a rule: {rule}", rule=rule_text(told.rule)),
            _area_text(told.rule),
            sentence("Until you answer, {robots} will not drive.", robots=listed(stands)) if stands else "",
            sentence("Shall it hold from now on?"),
        )
        return self._confirmations.put(shown, meant, to.robot, stands=stands)

    def _listed(self) -> str:
        rules = self._book.rules.rules
        if not rules:
            return sentence("There are no rules.")
        return together(*(rule_text(rule) for rule in rules))

    def _closing(self, place: str, rules: Sequence[Rule]) -> list[Rule]:
        """Those of some rules by which a place is closed."""
        words = _words_of(place)
        closing = [(rule, _words_of(rule.name)) for rule in rules if rule.kind == "keep_out"]
        return [rule for rule, name in closing if words and words in (name, name - _KINDS)]

    def _freed(self, text: str, to: Listener) -> str:
        """The place that may be entered again; for "in" or "there" the one refused last, or closed."""
        place = lifted_place(text)
        if place not in _NO_NAME:
            return place
        refused = [self._book.rules.get(name) for name in self._refused.get(to.robot, ())]
        closed = [rule for rule in (refused or self._all) if rule is not None and rule.kind == "keep_out"]
        return closed[0].name.casefold() if len(closed) == 1 else place

    def _lift(self, place: str, by: Principal, to: Listener) -> RuleReply | None:
        """A place is free again: what was only asked is asked no more, a rule is dropped after a yes."""
        if not _may(by):
            return None
        if self._closing(place, self._book.rules.rules):
            return self._drop(place, by, to)
        if question := self._confirmations.closing(self._closing(place, self._confirmations.proposed)):
            self._confirmations.withdraw(question)
            return RuleReply(sentence("All right, the rules stay as they are."), closes=question)
        return None

    def _drop(self, about: str, by: Principal, to: Listener) -> RuleReply:
        if not _may(by):
            return RuleReply(sentence("You may not change rules."))
        words = {word for word in re.findall(r"\w+", about) if word not in ("the", "a", "an")}
        fitting = [rule for rule in self._book.rules.rules if words <= _words(rule)]
        if not fitting:
            return RuleReply(sentence("There is no such rule."))
        if len(fitting) > 1:
            text = sentence("Which rule shall be dropped?")
        else:
            text = sentence("Shall I drop this rule: {rule}", rule=rule_text(fitting[0]))
        return self._confirmations.put(text, fitting, to.robot, drops=True)

    async def _answer(self, question: str, text: str, by: Principal) -> RuleReply | None:
        """What becomes of an answer; None if it is none, but something else that somebody wants."""
        if not _may(by):
            return RuleReply(sentence("You may not change rules."))
        answered = self._confirmations.answered(question, text)
        if answered is None:
            if text.rstrip().endswith("?") and len(text.split()) <= _SHORT:
                return self._confirmations.explained(question)
            unclear = sentence("Please answer with one of the choices, or with no.")
            return self._confirmations.again(question, unclear) if len(text.split()) <= _SHORT else None
        rule, drops = answered
        if rule is None:
            return RuleReply(sentence("All right, the rules stay as they are."), closes=question)
        try:
            if drops:
                await self._keeper.drop(rule.id, by)
                return RuleReply(sentence("The rule does not hold any more."), closes=question)
            await self._keeper.put(rule.model_copy(update={"by": by.name}), by)
        except ConfigError as error:
            said = sentence("I could not keep that: {reason}.", reason=str(error))
            return RuleReply(said, closes=question)
        return RuleReply(
            sentence("The rule holds from now on: {rule}", rule=rule_text(rule)), closes=question
        )


def _insisted_text(rules: Sequence[Rule]) -> str:
    """Which rules are in the way, and who may change them."""
    name = rules[0].name
    words = f"drop the rule about {name}" if name else "drop the rule"
    return together(
        sentence("I do not go past a rule, whoever asks."),
        *(rule_text(rule) for rule in rules),
        sentence(
            "Operators and supervisors may drop it (“{words}”) or change it on the page Rules.", words=words
        ),
    )


def left_over_rule(rule: Rule) -> str:
    """About a rule that was told and not agreed to when the program ended."""
    return sentence(
        "I was started anew before you answered, so this is no rule: {rule} Tell me again if it should be.",
        rule=rule_text(rule),
    )


def _words_of(text: str) -> set[str]:
    return set(re.findall(r"\w+", text.casefold()))


def _may(by: Principal) -> bool:
    return by.is_person and verdict(by, Effect.RULE) == "allow"


def _same(one: Rule, other: Rule) -> bool:
    """Whether two rules say the same, whoever told them in whichever words."""
    said = {"id": "", "words": "", "by": ""}
    return one.model_copy(update=said) == other.model_copy(update=said)


def _words(rule: Rule) -> set[str]:
    """By which words people may call a rule."""
    texts = (rule.name, rule.words, rule.id, *rule.robots, *rule.actions, rule_text(rule))
    return {word.casefold() for text in texts for word in re.findall(r"[^\W_]+", text)}


def _area_text(rule: Rule) -> str:
    """Where a zone lies on the map, for a person who has no map before them."""
    if not rule.corners:
        return ""
    xs, ys = [x for x, _ in rule.corners], [y for _, y in rule.corners]
    return sentence(
        "On the map it reaches from ({west}, {south}) to ({east}, {north}) metres.",
        west=f"{min(xs):g}",
        south=f"{min(ys):g}",
        east=f"{max(xs):g}",
        north=f"{max(ys):g}",
    )
