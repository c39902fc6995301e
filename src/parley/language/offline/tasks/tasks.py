"""From commands to steps: what the robot's own catalogue offers to do what was asked for.

The general kinds of tasks (going, looking, fetching) are put together from roles of actions; everything else
is matched against names, phrases and parameters of the catalogue. What cannot be done is said so.
"""

from __future__ import annotations

import re
from dataclasses import dataclass, replace

from parley.language.offline.scene.scene import UnclearError
from parley.language.offline.tasks.catalogue import call, goes_itself, parameter_role, text_inputs
from parley.language.offline.tasks.commands import Command, read_command
from parley.language.offline.tasks.fill import by_phrase
from parley.language.offline.tasks.going import UnableError
from parley.language.offline.tasks.machines import needs_machine
from parley.language.offline.tasks.matching import Match
from parley.language.offline.tasks.said import (
    amount,
    named_of,
    person_of,
    place_size,
    placed_text,
    spoken,
    start_of,
)
from parley.language.offline.tasks.spreading import spread
from parley.language.offline.tasks.towing import Towing
from parley.language.offline.words.durations import duration_s, without_duration
from parley.language.offline.words.lexicon import lexicon
from parley.language.offline.words.naming import name_words
from parley.language.offline.words.nouns import bare, noun_phrase
from parley.language.offline.words.saying import the
from parley.language.offline.words.text import Phrase, Word, keys, lemma, plain, tokens
from parley.language.offline.words.wording import asked_directly, turned
from parley.messages.status import ActionInfo

__all__ = ["Tasks", "UnableError"]


@dataclass
class Tasks(Towing):
    """The steps for one message, growing command by command."""

    def do(self, command: Command) -> None:
        """Add the steps for a command.

        Raises:
            UnclearError: Something has to be asked first.
            UnableError: Nothing in the catalogue does it.
        """
        each = spread(command, self.scene.objects)
        for one in each:
            self.do(one)
        if each:
            return
        start = len(self.steps)
        why = self._add(command)
        self._leave_out_ways(start)
        if names := [step.name for step in self.steps[start:]]:
            self.scene.trace.note("action", f"{', '.join(names)}: {why}")

    def _leave_out_ways(self, start: int) -> None:
        """Leave out going to where the next action goes by itself ("goes to a gauge and reads it")."""
        for at in range(len(self.steps) - 2, start - 1, -1):
            way, deed = self.steps[at], self.steps[at + 1]
            info, mover = self.catalogue.get(deed.name), self.catalogue.mover
            if info is None or mover is None or way.name != mover.name or way.flow is not None:
                continue
            there = [one.value for one in way.input_parameters.values() if isinstance(one.value, str)]
            same = any(one.value in there for one in deed.input_parameters.values())
            if same and goes_itself(info):
                del self.steps[at]

    def _add(self, command: Command) -> str:
        """Add the steps for a command; why just these is returned."""
        command = self._own_way(self._about_people(command))
        whole = self.catalogue.by_phrase(keys(command.clause))
        if whole is not None:
            self._invoke_each(whole, command)
            return "one of its phrases is what was said"
        if self._tow(command):
            return "what it couples is brought so"
        if self._released_already(command):
            return "that is planned already"
        match = self.own_match(command.clause)
        if match is not None and not (self._only_tells(match, command) or self._goes_on(match, command)):
            self.use_own(match, command.clause)
            return f"its name and inputs fit what was said ({match.score:.1f})"
        own = self.catalogue.for_verb(command.verb)
        own = own if own is None or self._may_mean(own, command) else None
        special = own is not None and command.kind in {"catalogue", "other"}
        if special and own is not None:
            self._invoke_each(own, command)
            return f"its name, a phrase or an example knows “{command.verb}”"
        if (scanned := self._by_instrument(command)) is not None:
            self.use_own(scanned, command.clause)
            return f"its name begins with “{command.verb}”"
        if self._narrowly(command):
            return "it looks at this kind of thing only"
        if needs_machine(command, self.catalogue) and not self._is_machine(command):
            raise UnableError(plain(command.clause))
        self._by_kind_or_description(command)
        return f"the catalogue's way to do what “{command.verb}” asks for ({command.kind})"

    def _may_mean(self, info: ActionInfo, command: Command) -> bool:
        """Whether an action that only begins like what is said can be meant: what is named must fit."""
        if not self._takes_kind_of(info, command.theme):
            return False
        if info.phrases or info.examples or info not in self.catalogue.of_own_kind:
            return True
        match = self.own_match(command.clause, weak=True, among=(info,), incomplete=True)
        if match is None or not match.plain:
            return False
        return not (match.filled.missing and any(part.grounded for part in match.filled.left))

    def _own_way(self, command: Command) -> Command:
        """For "fly to A", where that is how this robot gets about: going."""
        mover = self.catalogue.mover
        if command.kind not in {"other", "catalogue"} or mover is None or command.negated:
            return command
        told = {lemma(word) for word in re.findall(r"[a-z]+", mover.description.lower())}
        if command.verb.split()[0] not in {*name_words(mover.name), *told}:
            return command
        went = read_command((Word("go", "go"), *command.words), self.scene.is_person)
        return went if went is not None and went.kind == "motion" and went.place else command

    def _about_people(self, command: Command) -> Command:
        """Read "them" as somebody where only people can be meant."""
        persons = self.scene.persons
        them = persons and keys(command.theme) in {("them",), ("they",)}
        meant = them and command.kind in {"follow", "guide", "meet"}
        return replace(command, theme=persons[-1]) if meant else command

    def _by_kind_or_description(self, command: Command) -> None:
        """As its kind of task is done, else by an action whose description has all that is said.

        Raises:
            UnclearError: Something has to be asked first.
            UnableError: Nothing in the catalogue does it.
        """
        kept = len(self.steps), len(self.will), len(self.notes), self.here, self.carried
        try:
            self._by_kind(command)
        except (UnclearError, UnableError):
            match = self.own_match(command.clause, weak=True)
            if match is None:
                raise
            del self.steps[kept[0] :], self.will[kept[1] :], self.notes[kept[2] :]
            self.here, self.carried = kept[3:]
            self.use_own(match, command.clause)
            if command.kind == "grasp" and command.theme:
                self.carried = bare(self.scene.referent(command.theme))

    def _by_kind(self, command: Command) -> None:
        match command.kind:
            case "motion":
                self._go(command)
            case "back":
                self._back(command)
            case "look" | "whether":
                self._look_or_tell(command)
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

    def _look_or_tell(self, command: Command) -> None:
        """Look, but for "say whether you saw them", where there is nothing to look at."""
        tells = command.kind == "whether" and command.verb.split()[0] in {"say", "tell", "report", "let"}
        if tells and keys(command.words[:1]) == ("you",) and self.catalogue.with_role("speak") is not None:
            self._speak(replace(command, verb="say"))
        else:
            self._look(command)

    def _invoke_each(self, info: ActionInfo, command: Command) -> None:
        """An action of its own kind, once for everything that is named."""
        match = self._own_inputs(info, command)
        if match is not None:
            self.use_own(match, command.clause)
            return
        command = replace(command, theme=without_duration(command.theme))
        command = command if by_phrase(info, command) else self._at_its_place(info, command)
        quantified = bool({"and"} & set(keys(command.theme))) or noun_phrase(command.theme).quantifier
        members = self.scene.several(command.theme) if command.theme and quantified else []
        if len(members) < 2 or ("and" in keys(command.theme) and any(not self._grounds(m) for m in members)):
            self._invoke(info, command)
            return
        verb = command.clause[: len(command.clause) - len(command.words)]
        tail = amount(command.words)
        for member in members:
            words = (*member, *tail)
            self._invoke(info, replace(command, theme=member, words=words, clause=(*verb, *words)))

    def _own_inputs(self, info: ActionInfo, command: Command) -> Match | None:
        """What is said for an action's inputs, where only its own name tells what it does."""
        if info.phrases or info.examples or info not in self.catalogue.of_own_kind:
            return None
        match = self.own_match(command.clause, weak=True, among=(info,), incomplete=True)
        return match if match is not None and match.plain and not match.filled.missing else None

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
        much = amount(anchor)
        anchor = anchor[: len(anchor) - len(much)] if much else anchor
        if self._is_one(theme) or not self._grounds(anchor):
            return command
        left = bare(theme[: start_of(keys(theme), noun.relation)])
        others = [n for n in text_inputs(info) if parameter_role(n) not in {"person", "text"}]
        if takes_place or len(others) > 1:
            return replace(command, theme=left, place=anchor)
        self._stand_at(self.scene.place(anchor))
        said = command.words[: start_of(keys(command.words), noun.relation)]
        return replace(command, theme=left, words=(*said, *much), clause=(*command.clause[:1], *said, *much))

    def _is_one(self, theme: Phrase) -> bool:
        """Whether words name something on the map, where it is said to be included."""
        core = " ".join(noun_phrase(theme).core)
        return self._grounds(theme) and self._grounds(tokens(core))

    def _other(self, command: Command) -> None:
        info = self.catalogue.for_verb(command.verb) or self.catalogue.for_verb(command.verb.split()[0])
        info = info if info is not None and self._may_mean(info, command) else None
        info = info or self.catalogue.with_role(command.kind)
        if command.kind == "answer":
            if info is not None and self.steps and self.steps[-1].name == info.name:
                # "Let A ask you something and answer it".
                return
            command = self._question_of(command, info)
        if command.kind == "count" and info is not None:
            command = self._counted_there(command, info)
        if info is None and (command.kind == "count" or self._is_read_there(command)):
            self._look(replace(command, kind="look"))
            return
        if info is None and command.kind == "wait":
            self._wait(command)
            return
        match = self.own_match(command.clause, weak=True) if info is None else None
        if match is not None:
            self.use_own(match, command.clause)
            return
        if info is None or not self._may_mean(info, command):
            raise UnableError(plain(command.clause))
        self._invoke_each(info, command)

    def _counted_there(self, command: Command, info: ActionInfo) -> Command:
        """For "how many cups are on the table", where the action takes the place apart."""
        noun = noun_phrase(command.theme)
        takes_place = any(parameter_role(name) == "place" for name in text_inputs(info))
        if not takes_place or len(text_inputs(info)) < 2 or command.place or len(noun.anchors) != 1:
            return command
        if not noun.core or not self._grounds(noun.anchors[0]):
            return command
        self._stand_at(self.scene.place(noun.anchors[0]))
        theme = bare(command.theme[: start_of(keys(command.theme), noun.relation)])
        return replace(command, theme=theme, words=theme, place=noun.anchors[0])

    def _question_of(self, command: Command, info: ActionInfo | None) -> Command:
        """What is to be answered, and whose question it is."""
        question = tokens("question")
        pointing = keys(command.theme) in {(), ("it",), ("them",), ("that",)}
        command = replace(command, theme=question, words=question) if pointing else command
        whose = (
            any(parameter_role(name) == "person" for name in text_inputs(info)) if info is not None else False
        )
        if whose and self.scene.persons and not command.recipient:
            return replace(command, recipient=self.scene.persons[-1])
        return command

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
        person = person_of(command.theme)
        where = command.source or next(iter(noun_phrase(command.theme).anchors), ())
        if where:
            self._stand_at(self.scene.place(where))
        elif keys(command.theme) in {("her",), ("him",), ("them",)} and not self.here:
            self._stand_at_person(bare(self.scene.referent(command.theme)))
        if command.verb == "accompany" and command.place:
            self._lead(replace(command, kind="guide", source=()))
            return
        self._invoke(info, replace(command, theme=person or command.theme, recipient=(), place=(), source=()))

    def _lead(self, command: Command) -> None:
        """Lead somebody somewhere: by an action, else by going ahead."""
        guide, goal = self.catalogue.with_role("guide"), command.place or command.recipient
        if guide is not None and command.source:
            self._stand_at(self.scene.place(command.source))
        if guide is not None or not goal or self.catalogue.mover is None:
            self._other(command)
            return
        if command.theme and self.scene.is_person(command.theme):
            self._stand_at_person(bare(self.scene.referent(command.theme)))
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
        where, rest = ((), said) if listener else placed_text(said)
        if where and self._grounds(where):
            for member in self.scene.several(where) or [where]:
                self._stand_at(self.scene.place(member))
                self._speak(replace(command, words=rest))
            return
        if keys(bare(listener)) in {("me",), ("us",)}:
            said, listener = self._find_out(bare(said)), ()
        if listener:
            self._go_to_person(listener)
        elif keys(command.words[:1]) == ("me",):
            said = self._find_out(bare(command.words[1:]))
        if all(parameter_role(name) == "person" for name in texts) and listener:
            # "Greet A" by an action of that name.
            who = plain(person_of(listener))
            self.steps.append(call(speaker, {texts[0]: who}, plain(command.clause)))
            self.will.append(f"{command.verb} {the(who)}")
            return
        if keys(bare(listener)) in {("her",), ("him",)}:
            listener = self.scene.referent(bare(listener))
        text = self._said_before(said) or ("hello" if keys(said) == ("hello",) else plain(said))
        text = asked_directly(said) if command.kind == "ask" else text
        if command.verb.startswith("introduce yourself") and self.scene.situation.robot:
            text = f"hello, I am {self.scene.situation.robot}"
        name = next((n for n in texts if parameter_role(n) == "text"), texts[0])
        values = {name: text}
        values |= {
            n: plain(person_of(listener))
            for n in texts
            if n != name and parameter_role(n) == "person" and listener
        }
        self.steps.append(call(speaker, values, f"say “{text}”"))
        self.will.append(f"say “{text}”")

    def _said_before(self, said: Phrase) -> str:
        """For "say the same (thing) there" what is said before it; else nothing."""
        if keys(said)[-1:] == ("there",):
            said = said[:-1]
        if keys(bare(said)) not in {("same",), ("same", "thing"), ("same", "again"), ("same", "words")}:
            return ""
        speakers = {info.name for info in self.catalogue.all_with_role("speak")}
        earlier = (step for step in reversed(self.steps) if step.name in speakers)
        step = next(earlier, None)
        values = step.input_parameters.items() if step is not None else ()
        return next((str(p.value) for n, p in values if parameter_role(n) == "text" and p.has_data), "")

    def _speaker(self, command: Command) -> ActionInfo | None:
        """The action to speak with: the one that is called like the verb, else one that takes any text."""
        speakers = self.catalogue.all_with_role("speak")
        first = command.verb.split()[0]
        named = next((info for info in speakers if name_words(info.name)[:1] == (first,)), None)
        free = (i for i in speakers if any(parameter_role(n) != "person" for n in text_inputs(i)))
        return named or next(free, None)

    def _ask(self, command: Command) -> None:
        """Ask somebody: by an action for it, else by saying the question to them."""
        listener = spoken(command, self.scene.is_person)[1]
        operator = keys(bare(listener)) in {("me",), ("us",)}
        here = self.scene.persons[-1] if self.scene.persons and self.here and not listener else ()
        if here and self._speaker(command) is not None:
            # "Find P and ask their name".
            self._speak(replace(command, words=(*here, *named_of(command.words))))
            return
        asker = self.catalogue.with_role("ask_operator")
        if self._speaker(command) is not None and listener and not operator:
            self._speak(command)
            return
        if asker is None:
            raise UnableError(plain(command.clause))
        if operator or not listener:
            self._ask_operator(command, asker)
            return
        self._go_to_person(listener)
        self._have_asked(asker, plain(turned(command.clause)))

    def _ask_operator(self, command: Command, asker: ActionInfo) -> None:
        """Put what is asked of nobody else to the operator: "ask me what to buy", "ask for help"."""
        said, listener = spoken(command, self.scene.is_person)
        if not said or (not listener and said[0].key not in _ASKING_FOR | lexicon().question_starts):
            self._other(command)
        elif self.here and not listener and keys(said[:1])[0] in lexicon().question_starts:
            # "Go to A and ask who it is": whoever is there.
            self._have_asked(asker, plain(turned(command.clause)))
        else:
            wanted = f"{'to ' if keys(command.words[1:2]) == ('to',) else ''}{plain(turned(said))}"
            self.steps += self._said(asker, f"I am to ask you {wanted}.", f"ask you {wanted}")
            self.will.append(f"ask you {wanted}")

    def _have_asked(self, asker: ActionInfo, what: str) -> None:
        """What only a person can do is asked of one."""
        what = what[:1].lower() + what[1:]
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
                if (size := place_size(flat, i)) and self._grounds(said[i + size :])
            ),
            (),
        )
        if place and noun.core:
            self._stand_at(self.scene.place(place))
            who = person_of(said[flat.index("of") + 1 :]) if "of" in flat else ()
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


_ASKING_FOR = frozenset({"for", "to", "whether", "if", "about"})
_NO_PLACE = frozenset({"of", "with", "from", "for", "against"})
