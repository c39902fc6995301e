"""What is done with people: they are found where they are before they are spoken to, followed or led.

Clauses are read here where somebody is described or a place is said for them; the rest is left alone.
"""

from __future__ import annotations

from dataclasses import dataclass

from parley.language.offline.facts.facts import strip_openers
from parley.language.offline.scene.people import Somebody, map_name_end, read_somebody
from parley.language.offline.tasks.catalogue import call, parameter_role, text_inputs
from parley.language.offline.tasks.commands import Command
from parley.language.offline.tasks.tasks import Tasks
from parley.language.offline.words.lexicon import lexicon
from parley.language.offline.words.naming import name_words
from parley.language.offline.words.nouns import bare
from parley.language.offline.words.saying import the
from parley.language.offline.words.text import Phrase, Word, keys, lemma, plain, singular, tokens
from parley.language.offline.words.wording import asked_directly
from parley.language.word_lists import load_data
from parley.messages.status import ActionInfo

__all__ = ["Meeting"]

_DATA = load_data("people")
_SUPERLATIVES = frozenset(_DATA["superlatives"])
_GREETINGS = frozenset(_DATA["greetings"])
_TOLD = frozenset(_DATA["told"])

_OPERATOR = frozenset({"me", "us"})
_PEOPLE = frozenset({"person", "people", "human", "humans", "someone", "somebody"})
_WHOEVER = frozenset((word,) for word in ("whoever", "whomever", "anyone", "anybody", "somebody", "someone"))
_ALL = frozenset({("everyone",), ("everybody",), ("all",)})


@dataclass
class Meeting(Tasks):
    """Steps that concern people whom a clause describes."""

    def meet(self, words: Phrase) -> bool:
        """Add the steps for a clause about people; False if it is none, or nothing here can find people.

        Args:
            words: One clause.

        Raises:
            UnclearError: Where they are can be more than one place.
            UnableError: There is no way to get there.
        """
        words = tuple(w for w in strip_openers(strip_openers(words), requests=True) if w.is_word)
        if self.here and keys(words[-1:]) == ("there",) and words[-2:-1] and words[-2].key.endswith("ing"):
            words = (*words[:-1], Word("at", "at"), Word("the", "the"), *tokens(self.here))
        if keys(words) in {("count",), ("count", "please")} and self.steps:
            counter = self.catalogue.with_role("count")
            return counter is not None and self.steps[-1].name == counter.name
        if len(words) < 2 + (keys(words[:1]) != ("count",)):
            return False
        flat = (lemma(words[0].key), *keys(words[1:]))
        if self._finder() is None:
            found = lexicon().verbs.match(flat)
            if self.catalogue.with_role("count") is not None and self._counted(words, flat):
                return True
            return found is not None and found[1].startswith("speak:") and self._deed(words, flat)
        return self._counted(words, flat) or self._most(words, flat) or self._deed(words, flat)

    def _deed(self, words: Phrase, flat: tuple[str, ...]) -> bool:
        found = lexicon().verbs.match(flat)
        kind, _, verb = found[1].partition(":") if found is not None else ("", "", "")
        rest = words[found[0] :] if found is not None else words
        if flat[:4] == ("show", "me", "the", "way"):
            return False
        rest = self._plainer(verb, rest)
        if flat[0] in {"have", "let"} and {"ask", "asks"} & set(flat):
            return self._answered(rest[1:] if found is None else words[1:])
        match kind:
            case "search" | "meet":
                return self._found(rest)
            case "motion" if verb.split()[0] in {"go", "come", "drive", "walk", "head", "move"}:
                return self._visited(rest)
            case "speak" | "ask":
                return self._told(verb, rest)
            case "answer":
                return self._answered(rest)
            case "follow" if keys(rest[:1]) != ("me",):
                return self._followed(rest)
            case "guide":
                return self._led(rest, of_things=False)
            case "transfer":
                return self._led(rest, of_things=True) or self._brought(verb, words, rest)
        if kind == "look" and verb.startswith("describe"):
            somebody = read_somebody(rest, self.scene)
            return (
                somebody is not None and not rest[somebody.size + 2 :] and self._found(rest[: somebody.size])
            )
        if flat[0] == "show":
            leads = "way" in flat or ("to" in flat and self.catalogue.with_role("guide") is not None)
            return self._led(rest, of_things=False) if leads else False
        return self._told("tell", rest[0:]) if flat[0] in {"give", "explain"} else False

    def _plainer(self, verb: str, rest: Phrase) -> Phrase:
        """What follows a verb, as it would follow "describe" or "look for" alone."""
        if verb.endswith(" person") and not read_somebody(rest, self.scene):
            # "Look for person sitting at the desk".
            return (Word("person", "person"), *rest)
        if verb.startswith("describe") and keys(rest[:2]) in {("to", "me"), ("to", "us"), ("for", "me")}:
            return rest[2:]
        return rest

    def _finder(self) -> ActionInfo | None:
        """The action that looks for people, else the one that looks for anything."""
        infos = [*self.catalogue.all_with_role("search"), *self.catalogue.all_with_role("meet")]
        infos += [i for i in self.catalogue.all_with_role("look") if _PEOPLE & set(name_words(i.name))]
        people = lexicon().person_words | {"human", "people", "face"}
        for info in infos:
            said = {singular(word) for word in name_words(info.name)}
            if said & people or any(parameter_role(name) == "person" for name in text_inputs(info)):
                return info
        return next((i for i in infos if not {parameter_role(n) for n in text_inputs(i)} & {"object"}), None)

    def _go_and_find(self, somebody: Somebody) -> None:
        """Be where somebody is said to be, and look for them."""
        finder = self._finder()
        met = self.here and keys(somebody.who) in {keys(p) for p in self.scene.persons[-1:]}
        if somebody.where:
            place = self.scene.place(somebody.where)
            met = met and place.value == self.here
            self._stand_at(place)
        if finder is not None and not met and keys(somebody.who) not in _ALL:
            self._add_look(finder, plain(somebody.who), f"look for {self._them(somebody)}")
        self.scene.persons.append(somebody.who)
        self.seen = somebody.who

    def _them(self, somebody: Somebody) -> str:
        general = somebody.who[0].key in {"somebody", "someone", "anyone", "anybody", "whoever", "everyone"}
        plural = any(w.key in {"people", "men", "women", "children", "persons"} for w in somebody.who)
        return plain(somebody.who) if general or plural else the(plain(somebody.who))

    def _is_worth_it(self, somebody: Somebody | None) -> bool:
        return somebody is not None and bool(somebody.where or (somebody.described and self.here))

    def _found(self, rest: Phrase) -> bool:
        """For "find the man in the red coat in the hall", "find them again in the hall"."""
        flat = keys(rest)
        finder = self._finder()
        again = bool(flat) and flat[0] in lexicon().person_pronouns and bool(self.scene.persons)
        if again and finder is not None and any(step.name == finder.name for step in self.steps):
            at = next((i for i in range(1, len(rest)) if map_name_end(rest[i:], self.scene)), 0)
            if at and at <= 3 and at + map_name_end(rest[at:], self.scene) == len(rest):
                self._go_and_find(Somebody(self.scene.persons[-1], bare(rest[at:]), len(rest)))
                return True
        somebody = read_somebody(rest, self.scene)
        if somebody is None or not self._is_worth_it(somebody) or somebody.size < len(rest):
            return False
        self._go_and_find(somebody)
        return True

    def _visited(self, rest: Phrase) -> bool:
        """For "go to A at B", where B tells where A is."""
        rest = rest[1:] if keys(rest[:1]) == ("to",) else rest
        somebody = read_somebody(rest, self.scene)
        if somebody is None or not somebody.where or somebody.size < len(rest):
            return False
        if not self.scene.is_person(somebody.who):
            return False
        self._stand_at(self.scene.place(somebody.where))
        self.scene.persons.append(somebody.who)
        return True

    def _told(self, verb: str, rest: Phrase) -> bool:
        """For "tell A at B that S", "say S to A at B", "greet A at B", "tell the name of A to C at D"."""
        if self.catalogue.with_role("speak") is None or (keys(rest[:1]) and rest[0].key in _OPERATOR):
            return self._reported(rest[1:]) if keys(rest[:1]) and verb == "tell" else False
        if verb in _GREETINGS:
            somebody = read_somebody(rest, self.scene)
            if somebody is None or not self._is_worth_it(somebody) or somebody.size < len(rest):
                return False
            self._go_and_find(somebody)
            self._utter(self._greeting(verb), somebody, verb)
            return True
        if keys(rest[:1]) and rest[0].key in lexicon().person_pronouns:
            return False
        listener = read_somebody(rest, self.scene)
        said = rest[listener.size :] if listener is not None else ()
        if listener is None or not said:
            listener, said = self._listener_behind(rest)
        if listener is None or not said or not self._is_worth_it(listener) or verb.split()[0] not in _TOLD:
            return False
        if keys(said[:1]) in {("that",), ("about",), ("to",), ("of",)} and len(said) > 1:
            said = said[1:]
        source = self._about_whom(said)
        if source is not None:
            self._go_and_find(source)
        self._go_and_find(listener)
        self._utter(asked_directly(said) if verb == "ask" else plain(said), listener, verb)
        return True

    def _greeting(self, verb: str) -> str:
        if verb.startswith("introduce") and self.scene.situation.robot:
            return f"hello, I am {self.scene.situation.robot}"
        return "goodbye" if "bye" in verb else "hello"

    def _listener_behind(self, rest: Phrase) -> tuple[Somebody | None, Phrase]:
        flat = keys(rest)
        for index in range(len(flat) - 2, 0, -1):
            if flat[index] != "to":
                continue
            somebody = read_somebody(rest[index + 1 :], self.scene)
            if somebody is not None and somebody.size == len(rest) - index - 1:
                return somebody, rest[:index]
        return None, ()

    def _about_whom(self, said: Phrase) -> Somebody | None:
        """Whom what is to be told is about, if they have to be seen first."""
        flat = keys(said)
        for index in range(len(flat) - 1):
            if flat[index] in {"of", "what", "how", "where"}:
                somebody = read_somebody(said[index + 1 :], self.scene)
                if somebody is not None and somebody.where:
                    return somebody
        return None

    def _reported(self, rest: Phrase) -> bool:
        """For "(tell me) what the man at the desk is wearing"."""
        if not rest or rest[0].key not in {"what", "how", "which"}:
            return False
        start = next((i for i in range(1, min(4, len(rest))) if read_somebody(rest[i:], self.scene)), 0)
        somebody = read_somebody(rest[start:], self.scene) if start else None
        if somebody is None or not somebody.where:
            return False
        self._go_and_find(somebody)
        if self.catalogue.with_role("speak") is not None:
            self._utter(plain(rest), None, "tell")
        return True

    def _utter(self, text: str, listener: Somebody | None, verb: str) -> None:
        speaker = self._speaker(Command("speak", verb))
        if speaker is None:
            return
        texts = text_inputs(speaker)
        free = [name for name in texts if parameter_role(name) == "text"]
        values: dict[str, str] = {}
        if listener is not None:
            values = {n: plain(listener.who) for n in texts if parameter_role(n) == "person"}
        values |= dict.fromkeys((free or [n for n in texts if n not in values])[:1], text)
        self.steps.append(call(speaker, values, f"say “{text}”"))
        self.will.append(f"say “{text}”")

    def _answered(self, rest: Phrase) -> bool:
        """For "answer the question of A at B"."""
        info = self.catalogue.with_role("answer")
        flat = keys(rest)
        if info is None:
            return False
        at = next((i + 1 for i, w in enumerate(flat[:6]) if w in {"of", "from", "by"}), 0)
        if not at and {"question", "questions"} & set(flat[:3]):
            at = next((i + 1 for i, w in enumerate(flat[:4]) if w in {"question", "questions"}), 0)
        somebody = read_somebody(rest[at:], self.scene)
        if somebody is None or not self._is_worth_it(somebody):
            return False
        self._go_and_find(somebody)
        texts = text_inputs(info)
        values = {n: plain(somebody.who) if parameter_role(n) == "person" else "question" for n in texts}
        self.steps.append(call(info, values, "answer the question"))
        self.will.append("answer the question")
        return True

    def _followed(self, rest: Phrase) -> bool:
        info = self.catalogue.with_role("follow")
        somebody, source, _goal = self._journey(rest)
        if info is None or somebody is None:
            return False
        if not (source or self._is_worth_it(somebody)):
            if not somebody.described or somebody.size < len(rest):
                return False
            self._with_them(info, somebody, (), f"follow {self._them(somebody)}")
            self.scene.persons.append(somebody.who)
            return True
        self._go_and_find(Somebody(somebody.who, source or somebody.where, somebody.size))
        self._with_them(info, somebody, (), f"follow {self._them(somebody)}")
        return True

    def _led(self, rest: Phrase, *, of_things: bool) -> bool:
        """For "guide A from B to C"; "take A from B to C" only of people."""
        guide = self.catalogue.with_role("guide")
        somebody, source, goal = self._journey(rest)
        if somebody is None or not goal or self.catalogue.mover is None:
            return False
        if not (source or somebody.where) or (of_things and not (somebody.named or somebody.who)):
            return False
        self._go_and_find(Somebody(somebody.who, source or somebody.where, somebody.size))
        place = self.scene.place(goal)
        if guide is not None:
            self._with_them(guide, somebody, goal, f"guide {self._them(somebody)} to {the(place.label)}")
            return True
        self.notes.append("I go ahead; whoever comes along can follow me.")
        self.travel(place, f"lead the way to {plain(goal)}")
        return True

    def _brought(self, verb: str, words: Phrase, rest: Phrase) -> bool:
        """For "bring it to the man in the red coat in the hall"."""
        person, what = self._listener_behind(rest)
        whoever = person is not None and keys(person.who) in _WHOEVER
        if person is None or not (person.described or whoever) or not person.where or not what:
            return False
        flat = keys(what)
        source = bare(what[flat.index("from") + 1 :]) if "from" in flat else ()
        theme = bare(what[: flat.index("from")] if source else what)
        self.do(Command("transfer", verb, False, theme, person.where, source, person.who, rest, words))
        return True

    def _with_them(self, info: ActionInfo, somebody: Somebody, goal: Phrase, saying: str) -> None:
        values = {
            n: plain(somebody.who) for n in text_inputs(info) if parameter_role(n) in {"person", "object"}
        }
        places = [n for n in text_inputs(info) if parameter_role(n) == "place" and n not in values]
        if goal and places:
            values[places[0]] = self.scene.place(goal).value
        if not values and text_inputs(info):
            values[text_inputs(info)[0]] = plain(somebody.who)
        self.steps.append(call(info, values, saying))
        self.will.append(saying)

    def _journey(self, rest: Phrase) -> tuple[Somebody | None, Phrase, Phrase]:
        """Who, from where and where to, of "A from B to C"."""
        somebody = read_somebody(rest, self.scene)
        if somebody is None:
            return None, (), ()
        tail, ends = rest[somebody.size :], {"from": (), "to": ()}  # type: tuple[Phrase, dict[str, Phrase]]
        if keys(tail[:2]) == ("the", "way"):
            tail = tail[2:]
        while tail:
            size = map_name_end(tail[1:], self.scene) if tail[0].key in {"from", "to", "into"} else 0
            if not size:
                return None, (), ()
            ends["from" if tail[0].key == "from" else "to"] = bare(tail[1 : 1 + size])
            tail = tail[1 + size :]
        return somebody, ends["from"], ends["to"]

    def _counted(self, words: Phrase, flat: tuple[str, ...]) -> bool:
        """For "how many people in the hall are sitting?"."""
        at = next((i + 2 for i in range(min(6, len(flat))) if flat[i : i + 2] == ("how", "many")), 0)
        at = at or next((i + 2 for i in range(min(6, len(flat))) if flat[i : i + 2] == ("number", "of")), 0)
        at = at or (1 if flat[:1] == ("count",) else 0)
        if not at:
            return False
        kept = tuple(w for w in words[at:] if w.key not in {"are", "is", "there", "they"})
        kept = bare(kept[1:]) if keys(kept[:1]) == ("of",) else bare(kept)
        counter = self.catalogue.with_role("count")
        if keys(kept) in {("them",), ("those",), ("these",)} and self.scene.persons and counter is not None:
            self._with_counter(counter, Somebody(self.scene.persons[-1], tokens(self.here), 1))
            return True
        somebody = read_somebody(kept, self.scene)
        if somebody is None or not self._is_worth_it(somebody):
            return False
        if keys(somebody.who[:1]) in {("the",)}:
            somebody = Somebody(somebody.who[1:], somebody.where, somebody.size)
        rest = kept[somebody.size :]
        somebody = Somebody((*somebody.who, *rest), somebody.where, len(kept))
        if counter is None:
            self._go_and_find(somebody)
            return True
        if somebody.where:
            self._stand_at(self.scene.place(somebody.where))
        self._with_counter(counter, somebody)
        return True

    def _with_counter(self, counter: ActionInfo, somebody: Somebody) -> None:
        texts = text_inputs(counter)
        places = [n for n in texts if parameter_role(n) == "place"]
        things = [n for n in texts if n not in places]
        values = {things[0]: plain(somebody.who)} if things else {}
        if places and somebody.where:
            values[places[0]] = self.scene.place(somebody.where).value
        self.steps.append(call(counter, values, f"count the {plain(somebody.who)}"))
        self.will.append(f"count the {plain(somebody.who)}")

    def _most(self, words: Phrase, flat: tuple[str, ...]) -> bool:
        """For "what is the biggest thing on the table?"."""
        at = next((i for i in range(len(flat)) if flat[i] in _SUPERLATIVES), -1)
        opens = flat[:2] == ("tell", "me") or flat[:1] in {("what",), ("which",), ("find",), ("name",)}
        opens = opens or flat[:2] == ("look", "for")
        if at < 0 or at > 7 or not opens:
            return False
        for index in range(at + 1, len(flat)):
            link = lexicon().places.match(flat, index)
            size = map_name_end(words[index + link[0] :], self.scene) if link is not None else 0
            if link is None or not size or link[1] in {"of", "with", "from"}:
                continue
            theme = tuple(w for w in words[at:index] if w.key not in {"is", "that", "there"})
            searcher = self._searcher(theme)
            if searcher is None or len(theme) < 2:
                return False
            self._stand_at(self.scene.place(bare(words[index + link[0] : index + link[0] + size])))
            self._add_look(searcher, plain(theme), f"look for the {plain(theme)}")
            if self.catalogue.with_role("speak") is not None and flat[0] not in {"find", "look"}:
                self._utter(f"the {plain(theme)}", None, "say")
            return True
        return False
