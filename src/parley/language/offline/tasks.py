"""From commands to steps: what the robot's own catalogue offers to do what was asked for.

The general kinds of tasks (going, looking, fetching) are put together from roles of actions; everything else
is matched against names, phrases and parameters of the catalogue. What cannot be done is said so.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

from parley.language.offline.carrying import Carrying
from parley.language.offline.catalogue import call, parameter_role, text_inputs
from parley.language.offline.commands import Command
from parley.language.offline.durations import duration_s, without_duration
from parley.language.offline.going import UnableError
from parley.language.offline.lexicon import lexicon
from parley.language.offline.nouns import bare, noun_phrase
from parley.language.offline.scene import UnclearError
from parley.language.offline.text import Phrase, Word, keys, plain
from parley.messages.status import ActionInfo

__all__ = ["Tasks", "UnableError"]


_HANDING = frozenset(
    {"bring", "bring over", "fetch", "give", "hand", "hand over", "deliver", "carry", "serve"}
)


@dataclass
class Tasks(Carrying):
    """The steps for one message, growing command by command."""

    def do(self, command: Command) -> None:
        """Add the steps for a command.

        Raises:
            UnclearError: Something has to be asked first.
            UnableError: Nothing in the catalogue does it.
        """
        start = len(self.steps)
        why = self._add(command)
        names = [step.name for step in self.steps[start:]]
        if names:
            self.scene.trace.note("action", f"{', '.join(names)}: {why}")

    def _add(self, command: Command) -> str:
        """Add the steps for a command; why just these is returned."""
        whole = self.catalogue.by_phrase(keys(command.clause))
        if whole is not None:
            self._invoke_each(whole, command)
            return "one of its phrases is what was said"
        own = self.catalogue.for_verb(command.verb)
        special = own is not None and command.kind in {"catalogue", "other"}
        topical = command.kind in {"other", "transfer", "place", "count", "look", "catalogue", "motion"}
        handing = command.verb in _HANDING or bool(command.recipient)
        named = any(self._grounds(phrase) for phrase in (command.theme, command.place) if phrase)
        if not special and topical and not handing and not (named and command.kind != "other"):
            about = self.catalogue.by_topic(keys(command.clause))
            special, own = about is not None, about or own
        if special and own is not None:
            self._invoke_each(own, command)
            return f"its name, a phrase or an example knows “{command.verb}”"
        self._by_kind(command)
        return f"the catalogue's way to do what “{command.verb}” asks for ({command.kind})"

    def _by_kind(self, command: Command) -> None:
        match command.kind:
            case "motion":
                self._go(command)
            case "back":
                self._back(command)
            case "look" | "whether":
                self._look(command)
            case "search" | "meet":
                self._search(command)
            case "transfer":
                self._fetch(command)
            case "follow" | "guide":
                self._with_somebody(command)
            case "grasp":
                self._grasp(command)
            case "place":
                self._place(command)
            case "speak" if self.catalogue.with_role("speak") is not None:
                self._speak(command)
            case _:
                self._other(command)

    def _invoke_each(self, info: ActionInfo, command: Command) -> None:
        """An action of its own kind, once for everything that is named."""
        command = replace(command, theme=without_duration(command.theme))
        quantified = bool({"and"} & set(keys(command.theme))) or noun_phrase(command.theme).quantifier
        members = self.scene.several(command.theme) if command.theme and quantified else []
        if len(members) < 2 or ("and" in keys(command.theme) and any(not self._grounds(m) for m in members)):
            self._invoke(info, command)
            return
        verb = command.clause[: len(command.clause) - len(command.words)]
        tail = _amount(command.words)
        for member in members:
            words = (*member, *tail)
            self._invoke(info, replace(command, theme=member, words=words, clause=(*verb, *words)))

    def _other(self, command: Command) -> None:
        info = self.catalogue.for_verb(command.verb) or self.catalogue.for_verb(command.verb.split()[0])
        info = info or self.catalogue.with_role(command.kind)
        if info is None and command.kind == "count":
            self._look(replace(command, kind="look"))
            return
        if info is None and command.kind == "wait":
            self._wait(command)
            return
        info = info or self.catalogue.by_description(keys(command.clause))
        if info is None:
            raise UnableError(plain(command.clause))
        self._invoke_each(info, command)

    def _with_somebody(self, command: Command) -> None:
        if command.kind == "guide":
            self._lead(command)
        else:
            self._follow(command)

    def _follow(self, command: Command) -> None:
        """Follow somebody, from where that is said to begin."""
        info = self.catalogue.with_role("follow")
        if info is None:
            self._other(command)
            return
        person = _person_of(command.theme)
        where = command.source or next(iter(noun_phrase(command.theme).anchors), ())
        if where:
            self._stand_at(self.scene.place(where))
        if info is not None:
            self._invoke(
                info, replace(command, theme=person or command.theme, recipient=(), place=(), source=())
            )

    def _lead(self, command: Command) -> None:
        """Lead somebody somewhere: by an action, else by going ahead."""
        guide, goal = self.catalogue.with_role("guide"), command.place
        if guide is not None or not goal or self.catalogue.mover is None:
            self._other(command)
            return
        self.notes.append("I go ahead; whoever comes along can follow me.")
        self.travel(self.scene.place(goal), f"lead the way to {plain(goal)}")

    def _wait(self, command: Command) -> None:
        """Wait for a time or an event without an action for it: the operator says when to go on."""
        asker = self.catalogue.with_role("ask_operator")
        until = "until" in keys(command.words)
        if duration_s(command.words) is None and not until:
            if not self.steps:
                raise UnableError(plain(command.clause))
            return
        if asker is None:
            self.notes.append("I cannot wait for a set time, so I go on at once.")
            return
        flat = keys(command.words)
        start = flat.index("for") if "for" in flat and not until else 0
        rest = plain(command.words[start:]).removeprefix("for ")
        over = f"Please tell me when I may go on: I am to wait {rest if until else f'for {rest}'}."
        self.steps += self._said(asker, over, f"ask you when to go on, after waiting {rest}")
        self.will.append(f"wait {rest if until else f'for {rest}'} (please tell me when I may go on)")

    def _speak(self, command: Command) -> None:
        """Say something, to somebody in particular if named: then where that person is."""
        speaker = self.catalogue.with_role("speak")
        texts = text_inputs(speaker) if speaker is not None else []
        if speaker is None or not texts:
            raise UnableError(plain(command.clause))
        said, listener = spoken(command, self.scene.is_person)
        if not said:
            raise UnclearError("What should I say?")
        if keys(bare(listener)) in {("me",), ("us",)}:
            said, listener = self._find_out(bare(said)), ()
        if listener:
            self._go_to_person(listener)
        elif keys(command.words[:1]) == ("me",):
            said = self._find_out(bare(command.words[1:]))
        text = "hello" if keys(said) == ("hello",) else plain(said)
        if command.verb.startswith("introduce yourself") and self.scene.situation.robot:
            text = f"hello, I am {self.scene.situation.robot}"
        name = next((n for n in texts if parameter_role(n) == "text"), texts[0])
        values = {name: text}
        values |= {
            n: plain(bare(listener))
            for n in texts
            if n != name and parameter_role(n) == "person" and listener
        }
        self.steps.append(call(speaker, values, f"say “{text}”"))
        self.will.append(f"say “{text}”")

    def _find_out(self, said: Phrase) -> Phrase:
        """For "tell me the name of the person in the hall": it has to be found out there first."""
        noun = noun_phrase(said)
        flat = keys(said)
        place = next(
            (
                said[i + size :]
                for i in range(len(flat))
                if (size := _place_size(flat, i)) and self._grounds(said[i + size :])
            ),
            (),
        )
        if place and noun.core:
            self._stand_at(self.scene.place(place))
            who = _person_of(said[flat.index("of") + 1 :]) if "of" in flat else ()
            start = len(said) - len(place)
            who = tuple(word for word in who if word in said[:start])
            if who and self.scene.is_person(who[:2] if len(who) > 1 else who):
                self._look_for(bare(who[:1]))
        return said

    def _go_to_person(self, listener: Phrase) -> None:
        noun = noun_phrase(listener)
        if noun.anchors and noun.anchors[0]:
            self._stand_at(self.scene.place(noun.anchors[0]))
        else:
            person = self.scene.referent(bare(listener))
            self._stand_at(self.scene.remembered_place(person))
        self.scene.mention(bare(listener[: len(noun.core)] if noun.anchors else listener))


def _amount(words: Phrase) -> Phrase:
    """How much is said behind what is acted on: "(every box) with 3 litres", "for ten seconds"."""
    flat = keys(words)
    counted = (i for i in range(1, len(flat)) if flat[i].isdigit() or flat[i] in lexicon().numbers)
    at = next((i for i in counted if flat[i - 1] in {"with", "for", "to", "by", "at"}), 0)
    return words[at - 1 :] if at > 1 else ()


def _place_size(flat: tuple[str, ...], index: int) -> int:
    found = lexicon().places.match(flat, index)
    return (
        found[0]
        if found is not None and index and flat[index] != "of" and index + found[0] < len(flat)
        else 0
    )


def _person_of(words: Phrase) -> Phrase:
    """Without where the person is."""
    relation = tuple(noun_phrase(words).relation.split())
    flat = keys(words)
    end = next(
        (i for i in range(len(flat)) if relation and flat[i : i + len(relation)] == relation), len(flat)
    )
    return bare(words[:end])


def _placed_listener(words: Phrase, size: int) -> int:
    """For "P at the desk that S": where S begins; 0 if P stands alone."""
    flat = keys(words)
    if lexicon().places.match(flat, size) is None:
        return 0
    return next(
        (
            i
            for i in range(size + 2, len(flat))
            if flat[i] in {"that", "to", "about", "what", "how", "who", "when", "where"}
        ),
        0,
    )


def spoken(command: Command, is_person: Callable[[Phrase], bool]) -> tuple[Phrase, Phrase]:
    """What is to be said and to whom: "tell P that S", "say S to P", "greet P"."""
    words = tuple(word for word in command.words if word.is_word)
    hello = (Word("hello", "hello"),)
    if command.verb in {
        "greet",
        "welcome",
        "say hello to",
        "say hi to",
        "introduce yourself to",
        "talk to",
        "speak to",
        "speak with",
        "talk with",
        "chat with",
        "have a word with",
    }:
        return hello, words
    flat = keys(words)
    if command.verb in {"tell", "inform", "notify", "remind", "warn", "alert"}:
        for size in range(min(3, len(words)), 0, -1):
            if is_person(words[:size]):
                placed = _placed_listener(words, size)
                if placed:
                    rest = words[placed:]
                    return (rest[1:] if keys(rest[:1]) in {("that",), ("about",), ("to",)} else rest), words[
                        :placed
                    ]
                rest = words[size:]
                return (rest[1:] if keys(rest[:1]) in {("that",), ("about",), ("to",)} else rest), words[
                    :size
                ]
    for index in range(len(flat) - 2, 0, -1):
        if flat[index] == "to" and is_person(_person_of(words[index + 1 :])):
            return bare(words[:index]), words[index + 1 :]
    return words, ()
