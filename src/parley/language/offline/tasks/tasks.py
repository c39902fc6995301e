"""From commands to steps: what the robot's own catalogue offers to do what was asked for.

The general kinds of tasks (going, looking, fetching) are put together from roles of actions; everything else
is matched against names, phrases and parameters of the catalogue. What cannot be done is said so.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

from parley.language.offline.scene.scene import UnclearError
from parley.language.offline.tasks.carrying import Carrying
from parley.language.offline.tasks.catalogue import call, parameter_role, text_inputs
from parley.language.offline.tasks.commands import Command
from parley.language.offline.tasks.going import UnableError
from parley.language.offline.words.durations import duration_s, without_duration
from parley.language.offline.words.lexicon import lexicon
from parley.language.offline.words.nouns import bare, noun_phrase
from parley.language.offline.words.saying import the
from parley.language.offline.words.text import Phrase, Word, keys, plain, split_name, tokens
from parley.language.offline.words.wording import asked_directly, turned
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
        command = self._about_people(command)
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

    def _about_people(self, command: Command) -> Command:
        """Read "them" as somebody where only people can be meant."""
        persons = self.scene.persons
        if command.kind not in {"follow", "guide", "meet"} or not persons:
            return command
        them = keys(command.theme) in {("them",), ("they",)}
        return replace(command, theme=persons[-1]) if them else command

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
            case "dock":
                self._dock(command)
            case "grasp":
                self._grasp(command)
            case "place":
                self._place(command)
            case "speak" if self.catalogue.with_role("speak") is not None:
                self._speak(command)
            case "ask":
                self._ask(command)
            case _:
                self._other(command)

    def _invoke_each(self, info: ActionInfo, command: Command) -> None:
        """An action of its own kind, once for everything that is named."""
        command = self._at_its_place(info, replace(command, theme=without_duration(command.theme)))
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

    def _at_its_place(self, info: ActionInfo, command: Command) -> Command:
        """For "open the window in the hall": to the hall first, unless the action takes the place itself."""
        theme = command.theme
        noun = noun_phrase(theme)
        takes_place = any(parameter_role(name) == "place" for name in text_inputs(info))
        if len(noun.anchors) != 1 or not noun.core or noun.relation in _NO_PLACE:
            return command
        if self.catalogue.mover is None or command.verb not in keys(command.clause[:1]) or command.place:
            return command
        anchor = noun.anchors[0]
        amount = _amount(anchor)
        anchor = anchor[: len(anchor) - len(amount)] if amount else anchor
        if self._is_one(theme) or not self._grounds(anchor):
            return command
        left = bare(theme[: _start_of(keys(theme), noun.relation)])
        others = [n for n in text_inputs(info) if parameter_role(n) not in {"person", "text"}]
        if takes_place or len(others) > 1:
            return replace(command, theme=left, place=anchor)
        self._stand_at(self.scene.place(anchor))
        said = command.words[: _start_of(keys(command.words), noun.relation)]
        return replace(
            command, theme=left, words=(*said, *amount), clause=(*command.clause[:1], *said, *amount)
        )

    def _is_one(self, theme: Phrase) -> bool:
        """Whether words name something on the map, where it is said to be included."""
        core = " ".join(noun_phrase(theme).core)
        return self._grounds(theme) and self._grounds(tokens(core))

    def _other(self, command: Command) -> None:
        info = self.catalogue.for_verb(command.verb) or self.catalogue.for_verb(command.verb.split()[0])
        info = info or self.catalogue.with_role(command.kind)
        reads = command.verb == "read" and bool(self.here or self._grounds(command.theme[-2:]))
        if info is None and (command.kind == "count" or reads):
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
        guide, goal = self.catalogue.with_role("guide"), command.place or command.recipient
        if guide is not None and command.source:
            self._stand_at(self.scene.place(command.source))
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
        rest = plain(turned(command.words[start:])).removeprefix("for ")
        over = f"Please tell me when I may go on: I am to wait {rest if until else f'for {rest}'}."
        self.steps += self._said(asker, over, f"ask you when to go on, after waiting {rest}")
        self.will.append(f"wait {rest if until else f'for {rest}'} (please tell me when I may go on)")

    def _speak(self, command: Command) -> None:
        """Say something, to somebody in particular if named: then where that person is."""
        speaker = self._speaker(command)
        texts = text_inputs(speaker) if speaker is not None else []
        if speaker is None or not texts:
            raise UnableError(plain(command.clause))
        said, listener = spoken(command, self.scene.is_person)
        place = listener if listener and lexicon().places.match(keys(listener)) is not None else ()
        if place:
            # Said between quotation marks, and where it is to be said.
            found = lexicon().places.match(keys(place))
            self._stand_at(self.scene.place(place[found[0] if found else 0 :]))
            listener = ()
        if not said:
            raise UnclearError("What should I say?")
        if keys(bare(listener)) in {("me",), ("us",)}:
            said, listener = self._find_out(bare(said)), ()
        if listener:
            self._go_to_person(listener)
        elif keys(command.words[:1]) == ("me",):
            said = self._find_out(bare(command.words[1:]))
        if all(parameter_role(name) == "person" for name in texts) and listener:
            # "Greet A" by an action of that name.
            who = plain(_person_of(listener))
            self.steps.append(call(speaker, {texts[0]: who}, plain(command.clause)))
            self.will.append(f"{command.verb} {the(who)}")
            return
        text = "hello" if keys(said) == ("hello",) else plain(said)
        text = asked_directly(said) if command.kind == "ask" else text
        if command.verb.startswith("introduce yourself") and self.scene.situation.robot:
            text = f"hello, I am {self.scene.situation.robot}"
        name = next((n for n in texts if parameter_role(n) == "text"), texts[0])
        values = {name: text}
        values |= {
            n: plain(_person_of(listener))
            for n in texts
            if n != name and parameter_role(n) == "person" and listener
        }
        self.steps.append(call(speaker, values, f"say “{text}”"))
        self.will.append(f"say “{text}”")

    def _speaker(self, command: Command) -> ActionInfo | None:
        """The action to speak with: the one that is called like the verb, else one that takes any text."""
        speakers = self.catalogue.all_with_role("speak")
        first = command.verb.split()[0]
        named = next((info for info in speakers if split_name(info.name)[:1] == (first,)), None)
        free = (i for i in speakers if any(parameter_role(n) != "person" for n in text_inputs(i)))
        return named or next(free, None)

    def _ask(self, command: Command) -> None:
        """Ask somebody: by an action for it, else by saying the question to them."""
        listener = spoken(command, self.scene.is_person)[1]
        operator = keys(bare(listener)) in {("me",), ("us",)}
        here = self.scene.persons[-1] if self.scene.persons and self.here and not listener else ()
        if here and self._speaker(command) is not None:
            # "Find P and ask their name".
            self._speak(replace(command, words=(*here, *_named_of(command.words))))
            return
        asker = self.catalogue.with_role("ask_operator")
        if self._speaker(command) is not None and listener and not operator:
            self._speak(command)
            return
        if asker is None:
            raise UnableError(plain(command.clause))
        if operator or not listener:
            self._other(command)
            return
        self._go_to_person(listener)
        self._have_asked(asker, plain(turned(command.clause)))

    def _have_asked(self, asker: ActionInfo, what: str) -> None:
        """What only a person can do is asked of one."""
        self.steps += self._said(asker, f"Please {what} and tell me the answer.", f"ask you to {what}")
        self.will.append(f"ask you to {what}, because I cannot do that myself")

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
        met = bool(self.here) and keys(listener) in {keys(person) for person in self.scene.persons}
        if met:
            return
        if noun.anchors and noun.anchors[0]:
            self._stand_at(self.scene.place(noun.anchors[0]))
        else:
            person = self.scene.referent(bare(listener))
            self._stand_at(self.scene.remembered_place(person))
        self.scene.mention(bare(listener)[: len(noun.core)] if noun.anchors else bare(listener))


_NO_PLACE = frozenset({"of", "with", "from", "for", "against"})


def _start_of(flat: tuple[str, ...], relation: str) -> int:
    wanted = tuple(relation.split())
    return next((i for i in range(len(flat)) if flat[i : i + len(wanted)] == wanted), len(flat))


def _named_of(words: Phrase) -> Phrase:
    """For "(ask) their name": what their name is."""
    if keys(words[:1]) in {("their",), ("his",), ("her",)}:
        return (*tokens("what their"), *words[1:], *tokens("is"))
    return words


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
    marks = [i for i, word in enumerate(command.words) if word.key == '"']
    if len(marks) > 1:
        outside = tuple(w for w in (*command.words[: marks[0]], *command.words[marks[-1] + 1 :]) if w.is_word)
        outside = outside[1:] if keys(outside[:1]) == ("to",) else outside
        return tuple(w for w in command.words[marks[0] + 1 : marks[-1]] if w.key != '"'), outside
    words = tuple(word for word in command.words if word.is_word)
    hello = (Word("hello", "hello"),)
    if command.verb in {
        "greet",
        "salute",
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
    if command.verb in {"ask", "tell", "inform", "notify", "remind", "warn", "alert"}:
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
            return words[:index], words[index + 1 :]
    return (words[1:] if flat[:1] == ("that",) and len(words) > 2 else words), ()
