"""Steps by actions of a kind of their own: found by their names, filled with what is said."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from parley.language.offline.scene.scene import OPERATOR, UnclearError
from parley.language.offline.tasks.carrying import Carrying
from parley.language.offline.tasks.catalogue import BY_INSTRUMENT, call, text_inputs
from parley.language.offline.tasks.choices import choices_of, says_choice, told_state
from parley.language.offline.tasks.commands import Command
from parley.language.offline.tasks.fill import named
from parley.language.offline.tasks.looking import ASKING
from parley.language.offline.tasks.matching import Match, best_match
from parley.language.offline.tasks.roles import is_narrow_look, number_inputs, parameter_role
from parley.language.offline.tasks.slots import COLOURS, kind_on_map
from parley.language.offline.tasks.stand_ins import kinds_on_map
from parley.language.offline.words.lexicon import lexicon
from parley.language.offline.words.naming import name_words
from parley.language.offline.words.nouns import bare, noun_phrase
from parley.language.offline.words.quantities import quantities, taken_by
from parley.language.offline.words.text import Phrase, keys, plain, singular, tokens
from parley.messages.chat import ActionCall
from parley.messages.status import ActionInfo

__all__ = ["OwnKind"]

_AT = frozenset({"in", "at", "on", "to", "near", "inside", "by", "from", "into", "onto", "beside", "behind"})


_ENDING = frozenset({"stop", "end", "finish", "cancel", "abort"})
_BEGINNING = frozenset({"start", "begin", "launch", "run", "turn"})


def _takes_language(info: ActionInfo) -> bool:
    return any({"language", "lang"} & set(name_words(name)) for name in text_inputs(info))


def _takes_text(info: ActionInfo) -> bool:
    return "text" in {parameter_role(name) for name in text_inputs(info)}


_LABEL = 4
"""Letters of a number or letter that tells equals apart, at most less one."""
_TAKING_ON = frozenset({"load", "collect", "pick", "fetch", "take", "retrieve", "gather"})


@dataclass
class OwnKind(Carrying):
    """How actions that belong to no common kind are used."""

    def own_match(
        self, words: Phrase, *, weak: bool = False, among: Sequence[ActionInfo] = (), incomplete: bool = False
    ) -> Match | None:
        """The action of its own kind that a clause asks for; None if its name does not say so clearly.

        Args:
            words: The clause.
            weak: Whether a fitting description is enough.
            among: The only actions that may be meant, if given.
            incomplete: Whether what is missing may be asked for even so.
        """
        spoken = tuple(word for word in words if word.is_word or word.key == '"')
        infos = among or (*self.catalogue.of_own_kind, *self._with_extras(spoken))
        match = best_match(infos, spoken, self.scene) if spoken and infos else None
        return (
            match
            if match is not None and (match.strong or (weak and (incomplete or match.complete)))
            else None
        )

    def _with_extras(self, words: Phrase) -> list[ActionInfo]:
        """Actions of a common kind of which more is said than such tasks say: one of a few values."""
        return [
            info
            for info in self.catalogue.infos
            if "speak" in self.catalogue.roles(info)
            and (_takes_language(info) or (info.optional and not _takes_text(info)))
            and info not in self.catalogue.of_own_kind
            and says_choice(info, words)
        ]

    def ends_own(self, words: Phrase) -> bool:
        """Whether "stop recording" ends what another action of this robot begins, and is no stop of all."""
        if len(words) < 2 or words[0].key not in _ENDING:
            return False
        match = self.own_match(words)
        if match is None or match.verb < 1.0 or not match.complete:
            return False
        about = name_words(match.info.name)[1:]
        names = (name_words(info.name) for info in self.catalogue.infos)
        return bool(about) and any(name[1:] == about and name[0] in _BEGINNING for name in names)

    def _only_tells(self, match: Match, command: Command) -> bool:
        """For a deed only told of ("tell A that B is done"), or words passed on where a look is nearer."""
        passes_on = any(parameter_role(name) == "text" for name in match.filled.phrases)
        able = self.catalogue.with_role("look", "search") is not None
        looks = passes_on and able and command.kind in {"look", "whether", "search"} and match.verb < 1.0
        told = command.kind == "speak" and not passes_on and "that" in keys(command.theme)
        return looks or (told and not match.verb_first)

    def _goes_on(self, match: Match, command: Command) -> bool:
        """For "take it to A" of what is on board: going there, not taking it once more."""
        left = any(part.before == "to" for part in match.filled.left)
        return (
            command.kind == "transfer" and bool(command.place and self.carried) and left and match.verb < 1.0
        )

    def _takes_kind_of(self, info: ActionInfo, theme: Phrase) -> bool:
        """Whether a narrow look may be at what is named: only traps for "check_trap (trap)"."""
        kinds = set(kinds_on_map(text_inputs(info)[0], self.scene.objects)) if is_narrow_look(info) else set()
        items = self.scene.ground(theme).candidates if kinds and theme else ()
        return not items or any(kinds & {singular(w) for w in name_words(item.class_name)} for item in items)

    def _narrowly(self, command: Command) -> bool:
        """Look at something, where all that this robot can look at is things of some kinds."""
        found = lexicon().verbs.match(tuple(command.verb.split()))
        looks = command.kind in {"look", "catalogue"} and found is not None and found[1].startswith("look:")
        able = self.catalogue.with_role("look") is not None
        return looks and not able and self.look_narrowly(command.theme, command.clause)

    def look_narrowly(self, theme: Phrase, words: Phrase) -> bool:
        """Look by the one action that looks only at things of the kind that is named, if there is one.

        Args:
            theme: What is to be looked at.
            words: The clause, for the operator.
        """
        fitting = [
            info
            for info in self.catalogue.of_own_kind
            if is_narrow_look(info)
            and kinds_on_map(text_inputs(info)[0], self.scene.objects)
            and self.scene.ground(theme).outcome == "match"
            and self._takes_kind_of(info, theme)
        ]
        if len(fitting) != 1:
            return False
        self.steps.append(call(fitting[0], {text_inputs(fitting[0])[0]: self._called(theme)}, plain(words)))
        self.will.append(_said(words))
        self.scene.mention(bare(theme))
        return True

    def _is_machine(self, command: Command) -> bool:
        """Whether this robot handles heavy things itself ("LiftPallet (pallet)", "set_down (load)")."""
        handling = [i for role in ("grasp", "place") for i in self.catalogue.all_with_role(role)]
        special = any(parameter_role(name) == "" for info in handling for name in text_inputs(info))
        return special or self.own_match(command.clause, weak=True) is not None

    def _by_instrument(self, command: Command) -> Match | None:
        """For "scan A", which is no mere look where an action of that name takes A ("scan_barcode")."""
        verb = command.verb.split()[0]
        if (
            command.kind != "look"
            or verb not in BY_INSTRUMENT
            or command.place
            or "for" in keys(command.clause)
        ):
            return None
        named = [info for info in self.catalogue.of_own_kind if name_words(info.name)[0] == verb]
        match = self.own_match(command.clause, weak=True, among=named) if len(named) == 1 else None
        return match if match is not None and match.complete and match.filled.values else None

    def use_own(self, match: Match, words: Phrase) -> None:
        """Add the steps for a matched action.

        Args:
            match: The action and what is said for its inputs.
            words: The clause, for the operator.

        Raises:
            UnclearError: A needed input is not said.
            UnableError: What it needs cannot be had.
        """
        info, filled = match.info, match.filled
        for fact in filled.recalled:
            self.scene.use(fact)
        for name in set(info.inputs) - set(filled.values):
            if (state := told_state(info, name, tokens(self.scene.situation.message))) is not None:
                # "Ring for help, it is urgent".
                filled.values[name] = state
        place = next((p for p in filled.left if p.grounded and (p.before in _AT or not info.inputs)), None)
        if place is not None and self.catalogue.mover is not None:
            self._stand_at(self.scene.place(place.words))
        spread = self._members(info, filled.phrases)
        for member in spread or [()]:
            each = dict(member)
            values = {
                name: named(each[name], self.scene)
                if name in each
                else self._value(info, name, value, filled.phrases)
                for name, value in filled.values.items()
            }
            self._use_once(info, values, filled.phrases, list(filled.missing), words)
        self.will.append(_said(words))
        for phrase in filled.phrases.values():
            self.scene.mention(bare(phrase))
        if (
            name_words(info.name)[0] in _TAKING_ON
            and filled.phrases
            and self.catalogue.with_role("grasp") is None
        ):
            self.carried = bare(self.scene.referent(next(iter(filled.phrases.values()))))

    def _members(self, info: ActionInfo, phrases: dict[str, Phrase]) -> list[tuple[tuple[str, Phrase], ...]]:
        """One use for each of several things ("both plates", "A and B")."""
        for name, phrase in phrases.items():
            if parameter_role(name) == "text":
                continue
            if not ("and" in keys(phrase) or noun_phrase(phrase).quantifier):
                continue
            members = self.scene.several(phrase)
            if len(members) > 1 and all(self._grounds(member) for member in members):
                return [((name, member),) for member in members]
        return []

    def _value(self, info: ActionInfo, name: str, value: Any, phrases: dict[str, Phrase]) -> Any:
        if name not in phrases or parameter_role(name) == "text" or not isinstance(value, str):
            return value
        if value in choices_of(info).get(name, {}).values():
            return value
        coloured = {"color", "colour"} & set(name_words(name))
        told = parameter_role(name) == "place" and "where" in keys(phrases[name][1:])
        there = self._where_that_is(phrases[name]) if told or kind_on_map(name, self.scene.objects) else ()
        if there or kind_on_map(name, self.scene.objects):
            return self._called(there or self._of_its_kind(name, phrases[name]), strict=False)
        return self._called(phrases[name], strict=bool(coloured) or not COLOURS & set(keys(phrases[name])))

    def _of_its_kind(self, name: str, phrase: Phrase) -> Phrase:
        """For "it" where an input is called by a kind of things: what was last named of that kind."""
        if keys(phrase) not in {("it",), ("that",), ("this",)}:
            return phrase
        kinds = {singular(word) for word in name_words(name)}
        for thing in self.scene.things[::-1]:
            found = self.scene.ground(thing)
            item = found.candidates[0] if found.outcome == "match" else None
            if item is not None and kinds & {singular(word) for word in name_words(item.class_name)}:
                return thing
        return phrase

    def _where_that_is(self, phrase: Phrase) -> Phrase:
        """For "it" that stands for the grass in the orchard, where an action takes the place: the orchard."""
        words = bare(self.scene.referent(phrase))
        if "where" in keys(words[1:]):
            return tokens(self.scene.place(words).value)
        if self._grounds(words):
            return ()
        noun = noun_phrase(words)
        if len(noun.anchors) == 1 and self._grounds(noun.anchors[0]):
            return bare(noun.anchors[0])
        if keys(phrase) not in {("it",), ("there",)}:
            return ()
        # What was looked for there is no place.
        named = (*self.scene.things[::-1], *self.scene.places[::-1])
        return bare(next((one for one in named if self._grounds(one)), ()))

    def _called(self, phrase: Phrase, *, strict: bool = True) -> str:
        """The words for something: an object of the map by its description, pronouns resolved.

        Args:
            phrase: What is said.
            strict: Whether a single word has to be a name ("red" may be the red one otherwise).
        """
        words = self._spoken_of(bare(self.scene.referent(phrase)))
        if keys(words) in {("me",), ("us",), ("operator",)}:
            return plain(OPERATOR)
        return named(words, self.scene, strict=strict and len(words) < 2)

    def _spoken_of(self, words: Phrase) -> Phrase:
        """For "the sample" after "sample 3", which is not on the map: that one."""
        if len(words) != 1 or self._grounds(words):
            return words
        last = next((bare(one) for one in self.scene.things[::-1] if words[0].key in keys(one)), ())
        labelled = keys(last)[:-1] == keys(words) and len(last[-1].key) < _LABEL
        return last if labelled else words

    def _use_once(
        self,
        info: ActionInfo,
        values: dict[str, Any],
        phrases: dict[str, Phrase],
        missing: list[str],
        words: Phrase,
    ) -> None:
        before: list[ActionCall] = []
        for name in list(info.inputs):
            handed = self.catalogue.handed_over(info, name)
            if handed is None:
                continue
            said = values.pop(name, "")
            pointing = not said or bool(ASKING & set(keys(phrases.get(name, ()))))
            if pointing and any(step.name == handed.name for step in self.steps):
                missing = [one for one in missing if one != name]
                continue
            steps = self.catalogue.chain(handed, {}, said, "") if said else None
            if steps is not None:
                before += steps
                missing = [one for one in missing if one != name]
        missing = self._from_answers(info, values, missing)
        missing = self._from_here(info, values, missing, owned="its" in keys(words))
        for name in missing:
            if any(name in step.output_parameters for step in self.steps):
                continue
            raise UnclearError(_question(info, name, words))
        step = call(info, values, plain(words))
        same = [
            one
            for one in self.steps[-1:]
            if (one.name, one.input_parameters) == (step.name, step.input_parameters)
        ]
        if not same or not values:
            self._leave_out_asked(step)
            self.steps += [*before, step]

    def _leave_out_asked(self, step: ActionCall) -> None:
        """For "What does A show? Go there and read it": it is read there, and not before as well."""
        last = len(self.steps) - 1
        ways = {info.name for role in ("motion", "locate") for info in self.catalogue.all_with_role(role)}
        while last >= 0 and self.steps[last].name in ways:
            last -= 1
        used = [str(one.value).lower() for one in step.input_parameters.values() if one.has_data]
        if not 0 <= last < len(self.steps) - 1 or self.here.lower() not in used:
            return
        earlier = self.steps[last]
        if earlier.flow is None and (earlier.name, earlier.input_parameters) == (
            step.name,
            step.input_parameters,
        ):
            del self.steps[last]

    def _from_answers(self, info: ActionInfo, values: dict[str, Any], missing: list[str]) -> list[str]:
        """What the operator said in answer to a question, for what was asked: a thing, or how much."""
        for name in list(missing):
            for hint in list(self.scene.hints):
                said = tokens(hint)
                value: str | float | None
                if name in number_inputs(info):
                    amounts = quantities(said)
                    value = (
                        taken_by(name, info.description).value_of(amounts[0]) if len(amounts) == 1 else None
                    )
                elif name in text_inputs(info) and parameter_role(name) != "text" and self._grounds(said):
                    value = self._called(said)
                else:
                    continue
                if value is not None:
                    values[name] = value
                    missing = [one for one in missing if one != name]
                    self.scene.hints.remove(hint)
                    break
        return missing

    def _from_here(
        self, info: ActionInfo, values: dict[str, Any], missing: list[str], *, owned: bool
    ) -> list[str]:
        """Where the robot is by then, for a place not said; what was last used for what is `owned`."""
        before = self.steps[-1].input_parameters if self.steps else {}
        for name in [n for n in missing if n in before and (owned or kind_on_map(n, self.scene.objects))]:
            # "Deliver it to room 4 and ring the bell", "shake A and measure its weight".
            values[name] = before[name].value
            missing = [one for one in missing if one != name]
        texts = [n for n in missing if n in text_inputs(info) and parameter_role(n) not in {"text", "person"}]
        if not texts:
            return missing
        there = self.here
        if not there and self.scene.things and self._grounds(self.scene.things[-1]):
            there = self._called(self.scene.things[-1])
        if not there:
            return missing
        values[texts[0]] = there
        return [name for name in missing if name != texts[0]]


def _question(info: ActionInfo, name: str, words: Phrase) -> str:
    what = " ".join(word for word in name_words(name) if len(word) > 1) or name
    if name in number_inputs(info):
        return f"What should the {what} be for “{plain(words)}”? Please name it."
    return f"Which {what} do you mean for “{plain(words)}”? Please name it."


def _said(words: Phrase) -> str:
    text = plain(words)
    asking = lexicon().be | lexicon().auxiliaries | lexicon().question_starts
    if words[0].key in asking and words[1:2] and words[1].key != "a":
        return f"find out “{text}”"
    return text[:1].lower() + text[1:] if words[0].is_capital and not words[0].raw.isupper() else text
