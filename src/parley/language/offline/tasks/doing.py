"""Carrying out commands of a message one by one: refused, repeated, on conditions."""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Iterator
from dataclasses import dataclass, replace

from parley.language.offline.facts.facts import Fact, strip_openers
from parley.language.offline.scene.grounding import ground_phrase
from parley.language.offline.scene.marks import marks_of
from parley.language.offline.scene.scene import UnclearError
from parley.language.offline.sentences.clauses import Clause
from parley.language.offline.sentences.conditions import is_rule
from parley.language.offline.tasks.commands import Command, read_command
from parley.language.offline.tasks.meaning import Meaning
from parley.language.offline.tasks.roles import is_narrow_look
from parley.language.offline.tasks.said import spoken
from parley.language.offline.words.lexicon import lexicon
from parley.language.offline.words.naming import kind_of, name_words
from parley.language.offline.words.nouns import bare
from parley.language.offline.words.saying import the
from parley.language.offline.words.text import Phrase, Word, keys, lemma, plain, tokens
from parley.messages.chat import Flow, FlowIf

__all__ = ["Doing"]


_CHECK_WHETHER = tokens("check whether")
_GIVING = frozenset({"give", "hand", "pass", "deliver", "bring", "serve", "offer"})


@dataclass
class Doing(Meaning):
    """How commands become steps, and on what they depend."""

    def _do(self, command: Command) -> None:
        self.scene.trace.note("frame", command.said())
        if command.negated:
            self._do_not(command)
            self.last = self.last or replace(command, negated=False)
            return
        if command.kind == "transfer" and command.verb in {"take"} and "instead" in keys(command.clause):
            command = replace(command, kind="motion", verb="go", place=command.theme, theme=())
        if command.kind == "need":
            # Said before what is wanted ("X is cold, get him Z"), the need only explains; alone it asks.
            self.last = command
            return
        command = self._at_each(command)
        if self._told_better(command):
            steps, will = self._before_last
            del self.tasks.steps[steps:]
            del self.tasks.will[will:]
            self.tasks.here = ""
        self.last = command
        self.tasks.holds = self._handed_on(command)
        self._before_last = len(self.tasks.steps), len(self.tasks.will)
        if (
            command.kind == "transfer"
            and not command.recipient
            and not command.place
            and self._carried_on(command)
        ):
            self._collect(command)
            return
        own = self.scene.catalogue.for_verb(command.verb)
        if own is not None and any(kind == "number" for kind in own.inputs.values()) and not own.outputs:
            self.tasks.do(command)
            return
        if command.kind == "whether" and self._own_check(command.words):
            return
        for _ in range(self._times(command)):
            self.tasks.do(_without_times(command))
            if self._times(command) > 1:
                self.tasks.here = ""

    def _at_each(self, command: Command) -> Command:
        """For "look into all rooms and see whether anybody is asleep": that is seen in each of them."""
        before = self.last
        unplaced = command.kind in {"whether", "search"} and not command.place and not command.negated
        if before is None or not unplaced or before.kind not in {"look", "motion"} or not command.theme:
            return command
        group = next((w for p in (before.theme, before.place) for w in p if marks_of(w)), None)
        called = ground_phrase(command.theme, self.scene.objects, strict=True).outcome
        here = group is not None and "none" in {called, self.scene.ground(command.theme).outcome}
        pointed = keys(command.theme)[0] in lexicon().thing_pronouns | {"there"}
        return replace(command, place=(group,)) if group is not None and here and not pointed else command

    def _told_better(self, command: Command) -> bool:
        """For "look at each box and tell me whether it is open": the second says what the first is for."""
        before = self.last
        looks = command.kind in {"look", "whether", "search"}
        if before is None or not looks or before.kind not in {"look", "motion"}:
            return False
        groups = [
            {word.key for phrase in (one.theme, one.place, one.words) for word in phrase if marks_of(word)}
            for one in (before, command)
        ]
        return bool(groups[0]) and groups[0] == groups[1]

    def _collect(self, command: Command) -> None:
        """Get something on board, or whatever an action of its own kind makes of it."""
        able = self.scene.catalogue.with_role("grasp", "ask_operator") is not None
        match = None if able else self.tasks.own_match(command.clause, weak=True)
        if match is None:
            self.tasks.collect(command)
            return
        self.tasks.use_own(match, command.clause)
        self.tasks.carried = bare(command.theme)
        self.scene.mention(self.tasks.carried)

    def _handed_on(self, command: Command) -> bool:
        """For "take A to B and give it to C": not put down at B."""
        following = self._parts[self._at + 1 : self._at + 2]
        if command.kind != "transfer" or command.recipient or not command.place or not following:
            return False
        then = keys(strip_openers(following[0].words, requests=True))
        return lemma(then[0]) in _GIVING and then[1:2] in {("it",), ("them",), ("that",)} if then else False

    def _looked_for_nothing(self, clause: Clause) -> None:
        """For "look into A and come back if somebody is in there": the condition says what is looked for."""
        last, flat = self.last, keys(clause.condition)
        general = flat[:1] in {
            ("somebody",),
            ("someone",),
            ("anybody",),
            ("anyone",),
            ("there",),
            ("something",),
        }
        plain_look = last is not None and last.kind == "look" and bool(last.theme) and not last.place
        if not plain_look or not general or not clause.late or not self.tasks.steps or last is None:
            return
        step, here = self.tasks.steps[-1], plain(bare(last.theme)).lower()
        said = [str(p.value).lower() for p in step.input_parameters.values() if p.has_data]
        if step.flow is None and said and all(here in value or value in here for value in said):
            del self.tasks.steps[-1:]
            del self.tasks.will[-1:]

    def _carried_on(self, command: Command) -> bool:
        """Whether a later clause says where what is fetched goes ("get the box and bring it to A")."""
        later = (read_command(c.words, self.scene.is_person) for c in self._parts[self._at + 1 :])
        return any(c is not None and c.kind in {"transfer", "place", "guide"} for c in later)

    def _times(self, command: Command) -> int:
        flat = keys(command.clause)
        if flat[-1:] == ("twice",):
            return 2
        if flat[-1:] == ("times",) and len(flat) > 1:
            word = flat[-2]
            return min(lexicon().numbers.get(word, int(word) if word.isdigit() else 1), 10)
        return 1

    def _condition(self, clause: Clause) -> None:
        """Look first, then act or not."""
        before = self._parts[self._at - 1] if 0 < self._at <= len(self._parts) else None
        if not clause.condition:
            # "If it is, V, otherwise W": W depends on the same look as V, which may look at something itself.
            goes_on = clause.otherwise and before is not None and before.conditional and not before.condition
            if goes_on and before is not None and before.otherwise and clause.anew:
                # "If not, look at B. If not, W": W depends on the look at B.
                goes_on = self._last_look() <= self._checked[1]
            self._checked = self._checked if goes_on else ((), self._last_look())
            if goes_on and clause.otherwise:
                self._back_to_the_look()
            elif not goes_on:
                self._looked_from = self.tasks.here
        elif not self._same_condition(clause):
            if is_rule(clause.condition):
                said = f"If {plain(clause.condition)}, {plain(clause.words)}"
                self.remember(
                    Fact(bare(clause.condition[-2:]), relation="protocol", state=clause.words, sentence=said)
                )
                return
            look = read_command(
                (Word("check", "check"), Word("whether", "whether"), *self._named_later(clause)),
                self.scene.is_person,
            )
            if look is None:
                raise UnclearError(f"How can I tell whether {plain(clause.condition)}?")
            self._looked_for_nothing(clause)
            looked_from = len(self.tasks.steps)
            if not (
                self._told_by_last(clause.condition)
                or self._own_check(self._where_it_is_so(clause.condition) or clause.condition)
            ):
                self.tasks.do(look)
                self._one_look(looked_from)
                self._of_all(looked_from, clause.condition)
            self._checked = (clause.condition, len(self.tasks.steps) - 1)
            self._looked_from = self.tasks.here
        elif clause.otherwise:
            self._back_to_the_look()
        start, told = len(self.tasks.steps), len(self.tasks.will)
        words = self._what_was_found(clause)
        self._clause(replace(clause, words=words, condition=(), conditional=False), alone=False, index=1)
        flow = Flow(if_=FlowIf(step=self._checked[1], result=not clause.otherwise))
        self.tasks.steps[start:] = [
            step.model_copy(update={"flow": flow}) for step in self.tasks.steps[start:]
        ]
        word = "if not" if clause.otherwise else "if so"
        if len(self.tasks.will) > told:
            self.tasks.will[told] = f"{word}, {self.tasks.will[told]}"

    def _what_was_found(self, clause: Clause) -> Phrase:
        """For "if it is not there, tell A": what A is to be told; for "..., look in B" what is sought."""
        command = read_command(clause.words, self.scene.is_person)
        sought = self.last if clause.otherwise and not clause.condition else None
        placed = sought is not None and sought.kind == "whether" and bool(sought.place and sought.theme)
        finds = sought is not None and (
            sought.kind == "search" or (placed and not self._stands(sought.theme))
        )
        if sought is not None and finds and command is not None and command.kind == "look":
            named = (
                bool(command.theme)
                and not command.place
                and self.scene.ground(command.theme).outcome == "match"
            )
            return (
                (*tokens("look for"), *sought.theme, *tokens("at"), *command.theme) if named else clause.words
            )
        if command is None or command.kind != "speak" or command.verb not in {"tell", "inform", "notify"}:
            return clause.words
        said, listener = spoken(command, self.scene.is_person)
        if said or not listener or listener[0].key in lexicon().operator_pronouns:
            return clause.words
        seen = plain(clause.condition)
        look = self.tasks.steps[self._checked[1]]
        values = [str(p.value) for p in look.input_parameters.values() if p.has_data]
        if not seen and values:
            asked = values[0].removeprefix("whether ")
            seen = asked if asked != values[0] else f"{the(asked)} is there"
        found = tokens(seen)
        link = next((i for i, word in enumerate(found) if word.key in lexicon().be), -1) + 1
        denied = tokens("not") if clause.otherwise and link else ()
        return (*clause.words, *tokens("that"), *found[:link], *denied, *found[link:])

    def _stands(self, theme: Phrase) -> bool:
        """Whether something is on the map, and nothing that is sought."""
        return ground_phrase(theme, self.scene.objects, strict=True).outcome != "none"

    def _back_to_the_look(self) -> None:
        """What is done otherwise begins where it looked; "it" and "there" are what it looked at."""
        self.tasks.here = self._looked_from
        if self._looked_from:
            self.scene.mention(tokens(self._looked_from))
            return
        look = self.tasks.steps[self._checked[1]]
        said = (
            tokens(p.value) for p in look.input_parameters.values() if isinstance(p.value, str) and p.value
        )
        for words in said:
            if self.scene.ground(words).outcome == "match":
                self.scene.mention(words)

    def _told_by_last(self, condition: Phrase) -> bool:
        """Whether the step before tells it: "scan A; if there is an intruder" where it gives `intruder`."""
        last = self.tasks.steps[-1] if self.tasks.steps else None
        info = self.scene.catalogue.get(last.name) if last is not None and last.flow is None else None
        said = {word for key in keys(condition) for word in (key, lemma(key))}
        return info is not None and any(
            kind == "boolean" and set(name_words(name)) <= said for name, kind in info.outputs.items()
        )

    def _own_check(self, condition: Phrase) -> bool:
        """Tell whether something is so by an action of its own kind, where nothing else can look."""
        looks = self.scene.catalogue.with_role("look", "search") is not None
        pointed = keys(condition[:1]) in {("it",), ("they",), ("that",)}
        if pointed and self._last_measured(condition, looks=looks):
            # "Measure A; if it is too warm, V".
            return True
        if looks:
            return False
        for words in _as_checks(condition):
            match = self.tasks.own_match(words, weak=True)
            if match is None or match.filled.missing:
                continue
            if match.info.outputs or is_narrow_look(match.info):
                self.tasks.use_own(match, (*_CHECK_WHETHER, *condition))
                return True
        link = next((i for i, word in enumerate(condition) if word.key in lexicon().be | {"has", "have"}), 0)
        return self.tasks.look_narrowly(bare(condition[:link]), (*_CHECK_WHETHER, *condition))

    def _last_measured(self, condition: Phrase, *, looks: bool) -> bool:
        """Whether the last step told what is compared; any that tells anything if nothing else `looks`."""
        step = self.tasks.steps[-1] if self.tasks.steps else None
        info = self.scene.catalogue.get(step.name) if step is not None and step.flow is None else None
        if info is None or info not in self.scene.catalogue.of_own_kind or not info.outputs:
            return False
        numbers = any(kind_of(kind) == "number" for kind in info.outputs.values())
        compared = any(word.key[:1].isdigit() or word.key in lexicon().numbers for word in condition)
        return not looks or (numbers and compared)

    def _named_later(self, clause: Clause) -> Phrase:
        """For "Go to the desk only if it is free": the condition with what the order names."""
        condition = clause.condition
        mentioned = bool(self.scene.things or self.scene.persons) and not clause.late
        if keys(condition)[0] not in {"it", "they", "he", "she"} or mentioned:
            return condition
        where = self._where_it_is_so(condition)
        if where:
            return where
        command = read_command(clause.words, self.scene.is_person, self.scene.catalogue.verbs)
        named = tokens(the(plain(bare(command.place or command.theme)))) if command is not None else ()
        return (*named, *condition[1:]) if named else condition

    def _where_it_is_so(self, condition: Phrase) -> Phrase:
        """For "it is dark at A", where "it" is nothing: A is dark; empty if no place is said."""
        condition = tuple(word for word in condition if word.is_word) if condition[0].key == "it" else ()
        flat = keys(condition)
        compared = flat[2:3] and flat[2] in _COMPARED and any(word[:1].isdigit() for word in flat[3:5])
        ambient = flat[1:2] != () and flat[1] in lexicon().be and bool(compared or _AMBIENT & set(flat[2:4]))
        for at in range(3, len(condition)) if ambient else ():
            found = lexicon().places.match(flat, at)
            place = condition[at + found[0] :] if found is not None else ()
            if place and self.scene.ground(place).outcome == "match":
                lead = tokens("there is") if flat[at - 1].endswith("ing") else (*place, condition[1])
                return (*lead, *condition[2 : at if lead[1:] != tokens("is") else len(condition)])
        return ()

    def _of_all(self, before: int, condition: Phrase) -> None:
        """For "if none of the doors is shut": the last look tells of all of them, for V hangs on that one."""
        steps = self.tasks.steps
        looks = [step for step in steps[before:] if step.name == steps[-1].name]
        if len(looks) < 2 or plain(condition).lower().split()[0] not in {"none", "neither", "any", "no"}:
            return
        asked = {
            name: parameter.with_value(f"whether {plain(condition)}")
            for name, parameter in steps[-1].input_parameters.items()
            if str(parameter.value).startswith("whether ")
        }
        if asked:
            parameters = {**steps[-1].input_parameters, **asked}
            steps[-1] = steps[-1].model_copy(update={"input_parameters": parameters})
            self.tasks.will[-1:] = [f"check whether {plain(condition)}"]

    def _one_look(self, before: int) -> None:
        """Looking whether something is so takes the place of a look at the same thing just before."""
        steps = self.tasks.steps
        if before < 1 or len(steps) != before + 1 or steps[before].name != steps[before - 1].name:
            return
        if steps[before - 1].flow is not None:
            return
        general, special = (
            [str(p.value).lower() for p in step.input_parameters.values() if isinstance(p.value, str)]
            for step in steps[before - 1 :]
        )
        if len(general) == len(special) == 1 and general[0] in special[0]:
            del steps[before - 1]
            del self.tasks.will[-2:-1]

    def _seen_already(self, start: int) -> None:
        """A look at what was just looked at to see whether it is so says nothing more."""
        steps = self.tasks.steps
        if start < 1 or len(steps) != start + 1 or any(step.flow is not None for step in steps[start - 1 :]):
            return
        said = [
            [str(p.value).lower() for p in step.input_parameters.values() if isinstance(p.value, str)]
            for step in steps[start - 1 :]
        ]
        if steps[start].name != steps[start - 1].name or not len(said[0]) == len(said[1]) == 1:
            return
        special, general = (set(keys(tokens(text))) - lexicon().determiners for (text,) in said)
        named = self.scene.ground(tokens(said[1][0])).outcome != "none"
        if said[0][0].startswith("whether ") and not named and general and general < special:
            del steps[start:]
            del self.tasks.will[-1:]

    def _last_look(self) -> int:
        """The step that looked last, for "if not, ...".

        Raises:
            UnclearError: Nothing was looked at.
        """
        looks = {
            info.name
            for info in self.scene.catalogue.infos
            if self.scene.catalogue.roles(info) & {"look", "search", "meet"}
            or (info.outputs and info in self.scene.catalogue.of_own_kind)
        }
        for index in range(len(self.tasks.steps) - 1, -1, -1):
            if self.tasks.steps[index].name in looks:
                return index
        raise UnclearError("What does that depend on? Please tell me what I should look at first.")

    def _same_condition(self, clause: Clause) -> bool:
        return bool(self._checked[0]) and keys(self._checked[0]) == keys(clause.condition)

    def _side_by_side(self, start: int) -> None:
        """The steps from `start` on are done at the same time as the one before them, if that was asked."""
        steps, beside = self.tasks.steps, self.tasks.beside
        self.tasks.beside = False
        if beside and start < len(steps) and steps[start].flow is None and steps[start - 1].flow is None:
            steps[start] = steps[start].model_copy(update={"flow": Flow(together_with=start - 1)})
            self.tasks.will[-1] = f"{self.tasks.will[-1]} at the same time"

    @abstractmethod
    def _clause(self, clause: Clause, *, alone: bool, index: int) -> None:
        """Read one clause; what reads whole messages says how."""


def _as_checks(condition: Phrase) -> Iterator[Phrase]:
    """Orders for what tells whether something is so: "is A dry", "check A", "count the B on A", "read A"."""
    flat = keys(condition)
    link = next((i for i, word in enumerate(flat) if word in lexicon().be | {"has", "have"}), 0)
    if flat[:1] == ("there",) and link == 1:
        much = next(
            (i + 1 for i, word in enumerate(flat) if word[:1].isdigit() or word in lexicon().numbers), 0
        )
        yield (Word("count", "count"), *condition[much or link + 1 :])
    if link:
        subject, rest = condition[:link], condition[link + 1 :]
        if "than" in keys(rest[1:]):
            # "A is hotter than 30 degrees": how hot it is.
            yield (condition[link], *subject, *rest[: keys(rest).index("than")])
        yield (condition[link], *subject, *(word for word in rest if word.key != "not"))
        yield (Word("check", "check"), *subject)
        where = (i for i in range(link + 1, len(flat) - 1) if lexicon().places.match(flat, i) is not None)
        yield from ((Word("check", "check"), *condition[i + 1 :]) for i in where)
        return
    does = next((i for i in range(1, len(flat)) if flat[i].endswith("s") and lemma(flat[i]) != flat[i]), 0)
    for verb in (lemma(flat[does]), *(("read", "check") if flat[does] in _SHOWING else ())) if does else ():
        yield (Word(verb, verb), *condition[:does])


_SHOWING = frozenset({"shows", "reads", "says", "indicates", "displays", "measures", "reports", "gives"})


def _without_times(command: Command) -> Command:
    """Without "twice" and "three times" at the end of its parts."""

    def cut(phrase: Phrase) -> Phrase:
        flat = keys(phrase)
        if flat[-1:] == ("twice",):
            return phrase[:-1]
        return phrase[:-2] if flat[-1:] == ("times",) and len(flat) > 2 else phrase

    return replace(command, place=cut(command.place), theme=cut(command.theme))


_AMBIENT = frozenset({
    "dark", "light", "bright", "wet", "dry", "cold", "warm", "hot", "icy", "slippery", "windy", "foggy",
    "raining", "snowing", "quiet", "noisy", "loud", "crowded", "busy", "dusty", "smoky", "safe", "freezing",
    "damp", "humid", "muddy", "dim", "flooded",
})  # fmt: skip
_COMPARED = frozenset({
    "hotter", "warmer", "colder", "cooler", "darker", "brighter", "wetter", "drier", "louder", "above",
    "below", "over", "under",
})  # fmt: skip
"""What "it" is said to be somewhere where it stands for nothing."""
