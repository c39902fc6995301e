"""Talking about rules: told, asked about, dropped; each change counts after a person's yes."""

from __future__ import annotations

import re
import uuid
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Final

from parley.errors import ConfigError
from parley.gate.assent import assent_of
from parley.gate.book import RuleBook
from parley.gate.rules import RuleKeeper
from parley.gate.table import Effect, verdict
from parley.gate.told import DraftRule, NotUnderstood, lifted_place, told_rule
from parley.gate.wording import rule_text
from parley.latest import Latest
from parley.messages.principal import Principal
from parley.messages.rules import Rule
from parley.messages.status import ActionInfo
from parley.sentences import in_language, sentence, together
from parley.world.object_map import MapObject

__all__ = ["Listener", "RuleConfirmations", "RuleReply", "RuleTalk"]

_KEPT: Final = 100
_SHORT: Final = 2
"""So many words are meant as an answer, even if they fit no choice."""
_YES: Final = frozenset({"yes", "y", "ok", "okay", "sure", "yes please", "jah", "ja", "jaa", "olgu"})
_NO: Final = frozenset({"no", "n", "nope", "no thanks", "never mind", "ei", "ära"})
_LIST: Final = re.compile(
    r"^(?:what|which)(?: are the| are your)? rules(?: are there| hold| do you have| are in force)?$"
    r"|^(?:list|show|tell)(?: me)?(?: all)?(?: the| your)? rules$"
    r"|^(?:mis|millised) reeglid(?: on| kehtivad| sul on)?$"
)
_DROP: Final = re.compile(
    r"^(?:please )?(?:drop|delete|remove|forget|lift|cancel) the rules?"
    r"(?: (?:about|on|for|that) (?P<about>.+))?$"
    r"|^(?:palun )?(?:kustuta|tühista|unusta) reegel(?: (?P<kohta>.+?)(?: kohta)?)?$"
)


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


@dataclass(frozen=True, slots=True)
class RuleReply:
    """What is said to the person."""

    text: str
    id: str = ""
    """Of a question; empty: nothing is asked."""
    choices: tuple[str, ...] = ()
    closes: str = ""
    """The question that is settled by it."""


@dataclass(frozen=True, slots=True)
class _Pending:
    """A change that waits for a yes: what each choice would put in force, None to drop `drops`."""

    choices: tuple[tuple[str, Rule], ...]
    drops: bool = False

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

    def rules(self, question: str) -> tuple[Rule, ...]:
        """What is asked about."""
        pending = self._waiting.get(question)
        return tuple(rule for _, rule in pending.choices) if pending is not None else ()

    def put(self, text: str, rules: Sequence[Rule], *, drops: bool = False) -> RuleReply:
        """Ask about a change, or which rule to drop; of several to make, the text says the first."""
        labels = [sentence("yes") if len(rules) == 1 else rule_text(rule) for rule in rules]
        return self._asked(text, _Pending(tuple(zip(labels, rules, strict=True)), drops))

    def again(self, question: str) -> RuleReply:
        """Ask once more what was not answered clearly."""
        text = sentence("Please answer with one of the choices, or with no.")
        return replace(self._asked(text, self._waiting.pop(question)), closes=question)

    def _asked(self, text: str, pending: _Pending) -> RuleReply:
        question = uuid.uuid4().hex
        self._waiting[question] = pending
        return RuleReply(text, question, (*(label for label, _ in pending.choices), sentence("no")))

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
    return {_plain(in_language(label, language)) for language in ("en", "et")}


class RuleTalk:
    """What the chat asks about rules before any language engine sees a message.

    Args:
        book: The rules in force.
        keeper: Where they are kept.
    """

    def __init__(self, book: RuleBook, keeper: RuleKeeper) -> None:
        self._book, self._keeper = book, keeper
        self._confirmations = RuleConfirmations()

    def asked(self, question: str) -> bool:
        """Whether this question is one of ours."""
        return self._confirmations.asked(question)

    def concerns(self, text: str, to: Listener) -> bool:
        """Whether words are about rules, whatever else is asked at the moment."""
        said = _plain(text).rstrip("?")
        return bool(
            _LIST.match(said)
            or _DROP.match(said)
            or self._closed(lifted_place(text))
            or self._told(text, to) is not None
        )

    async def reply(self, text: str, by: Principal, to: Listener, *, answers: str = "") -> RuleReply | None:
        """What to say to a message that is about rules; None for every other message.

        Args:
            text: What was said.
            by: Who says it.
            to: Who is spoken to.
            answers: The question that it answers, if it does.
        """
        if answers and self.asked(answers):
            reply = await self._answer(answers, text, by)
            if reply is not None:
                return reply
        said = _plain(text).rstrip("?")
        if _LIST.match(said):
            return RuleReply(self._listed())
        if found := _DROP.match(said):
            return self._drop(found["about"] or found["kohta"] or "", by)
        if (place := lifted_place(text)) and (lifted := await self._lift(place, by)) is not None:
            return lifted
        told = self._told(text, to)
        if told is None:
            return None
        if not _may(by):
            return RuleReply(sentence("You may not change rules."))
        if isinstance(told, NotUnderstood):
            return RuleReply(told.sentence)
        return self._proposed(told)

    def _told(self, text: str, to: Listener) -> DraftRule | NotUnderstood | None:
        return told_rule(
            text, places=to.places, catalogue=to.catalogue, robots=to.robots, robot=to.robot, busy=to.busy,
            zones=self._book.rules.rules,
        )  # fmt: skip

    def _proposed(self, told: DraftRule) -> RuleReply:
        at_once = told.rule.kind == "keep_out"
        if at_once:  # it takes nothing away from anybody's safety
            self._keeper.try_out(told.rule)
        shown = together(
            sentence("I understand this as a rule: {rule}", rule=rule_text(told.rule)),
            _area_text(told.rule),
            sentence("I keep to it until you answer.") if at_once else "",
            sentence("Shall it hold from now on?"),
        )
        return self._confirmations.put(shown, (told.rule, *told.others))

    def _listed(self) -> str:
        rules = self._book.rules.rules
        if not rules:
            return sentence("There are no rules.")
        return together(*(rule_text(rule) for rule in rules))

    def _closed(self, place: str) -> list[Rule]:
        """The rules by which a place is closed."""
        words = set(re.findall(r"\w+", place))
        rules = [rule for rule in self._book.rules.rules if rule.kind == "keep_out"]
        return [rule for rule in rules if words and words == set(re.findall(r"\w+", rule.name.casefold()))]

    async def _lift(self, place: str, by: Principal) -> RuleReply | None:
        """A place is free again: what was only asked about holds no longer, a rule is dropped after a yes."""
        fitting = self._closed(place)
        if not fitting or not _may(by):
            return None
        if not all(self._keeper.is_tried(rule.id) for rule in fitting):
            return self._drop(place, by)
        for rule in fitting:
            self._keeper.let_go(rule.id)
        return RuleReply(sentence("The rule does not hold any more."))

    def _drop(self, about: str, by: Principal) -> RuleReply:
        if not _may(by):
            return RuleReply(sentence("You may not change rules."))
        words = {word for word in re.findall(r"\w+", about) if word not in ("the", "a", "an")}
        fitting = [rule for rule in self._book.rules.rules if words <= _words(rule)]
        if not fitting:
            return RuleReply(sentence("There is no such rule."))
        if len(fitting) > 1:
            return self._confirmations.put(sentence("Which rule shall be dropped?"), fitting, drops=True)
        text = sentence("Shall I drop this rule: {rule}", rule=rule_text(fitting[0]))
        return self._confirmations.put(text, fitting, drops=True)

    async def _answer(self, question: str, text: str, by: Principal) -> RuleReply | None:
        """What becomes of an answer; None if it is none, but something else that somebody wants."""
        if not _may(by):
            return RuleReply(sentence("You may not change rules."))
        tried = self._confirmations.rules(question)
        answered = self._confirmations.answered(question, text)
        if answered is None:
            return self._confirmations.again(question) if len(text.split()) <= _SHORT else None
        rule, drops = answered
        for other in tried if not drops else ():
            self._keeper.let_go(other.id)
        if rule is None:
            return RuleReply(sentence("All right, the rules stay as they are."), closes=question)
        try:
            if drops:
                await self._keeper.drop(rule.id)
                return RuleReply(sentence("The rule does not hold any more."), closes=question)
            await self._keeper.put(rule.model_copy(update={"by": by.name}))
        except ConfigError as error:
            said = sentence("I could not keep that: {reason}.", reason=str(error))
            return RuleReply(said, closes=question)
        return RuleReply(
            sentence("The rule holds from now on: {rule}", rule=rule_text(rule)), closes=question
        )


def _may(by: Principal) -> bool:
    return by.is_person and verdict(by, Effect.RULE) == "allow"


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
