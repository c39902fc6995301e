"""Steps that bring something from one place to another, by actions or with the operator's help."""

from __future__ import annotations

from abc import abstractmethod
from dataclasses import dataclass, field, replace

from parley.language.offline.facts.remembering import find_fact, of_others
from parley.language.offline.scene.people import map_name_end
from parley.language.offline.scene.scene import OPERATOR, Place, UnclearError
from parley.language.offline.tasks.catalogue import parameter_role, text_inputs
from parley.language.offline.tasks.commands import Command
from parley.language.offline.tasks.going import UnableError
from parley.language.offline.tasks.looking import ASKING, Looking
from parley.language.offline.tasks.stand_ins import kinds_on_map
from parley.language.offline.words.lexicon import lexicon
from parley.language.offline.words.nouns import bare, coordinated, noun_phrase
from parley.language.offline.words.saying import the, where_is
from parley.language.offline.words.text import Phrase, Word, keys, plain, singular, tokens
from parley.language.word_lists import load_data
from parley.messages.status import ActionInfo

__all__ = ["Carrying"]

_ANYTHING = frozenset((word,) for word in ("things", "objects", "something", "stuff", "people", "anything"))


_ON_BOARD = frozenset({"you", "your tray", "your back", "robot", "the robot", "your basket", "your shelf"})
_DEEDS_GIVEN = frozenset((word,) for word in load_data("names")["deeds_given"])
"""What is given by doing something, not by handing something over."""
_TO_CARRY = ("motion", "grasp", "fetch", "handover", "place", "ask_operator", "guide")
"""Without any of these nothing can be brought anywhere."""
_TURNS = 4
"""How many turns back what was said about a thing still holds."""
_MORE = frozenset({("more",), ("extra",), ("additional",)})
_WAYS = frozenset(
    [
        "lift",
        "elevator",
        "stairs",
        "staircase",
        "ramp",
        "exit",
        "entrance",
        "door",
        "gate",
        "aisle",
        "corridor",
        "hallway",
        "route",
        "road",
        "path",
        "bridge",
        "tunnel",
        "passage",
        "escalator",
        "way",
        "lane",
        "spot",
        "place",
    ]
)


@dataclass
class Carrying(Looking):
    """How to bring things."""

    given: list[tuple[tuple[str, ...], tuple[str, ...]]] = field(default_factory=list)
    """What is handed to whom by the steps so far."""

    def _fetch(self, command: Command) -> None:
        if self.catalogue.with_role(*_TO_CARRY) is None:
            raise UnableError(plain(command.clause))
        if command.verb == "give" and keys(command.theme[-1:]) in _DEEDS_GIVEN:
            raise UnableError(plain(command.clause))
        if not command.theme:
            raise UnclearError(f"What should I {command.verb}?")
        members = coordinated(command.theme) if "and" in keys(command.theme) else []
        if len(members) > 1 and not self._knows(command.theme) and all(self._knows(m) for m in members):
            # "The pen and the paper": one after the other.
            for member in members:
                self._fetch_one(replace(command, theme=member))
            return
        self._fetch_one(command)

    def _fetch_one(self, command: Command) -> None:
        if self._way_taken(command) or self._taken_along(command):
            return
        command = self._from_where_it_is(command)
        only = (
            not command.recipient
            and not command.place
            and command.verb in {"get", "grab", "retrieve", "go get", "get hold of"}
        )
        if only and self.catalogue.with_role("grasp") is not None:
            self.collect(command)
            return
        if self._fetched_by_action(command):
            return
        theme, source = self._theme(command)
        if self.scene.is_person(theme):
            self._guide(command, theme)
            return
        self._must_move(command, theme, source)
        if source is not None and source.value.lower() in _ON_BOARD:
            # "I have put it on you": it is there already.
            self.carried, source = theme, None
        recipient, goal = self._destination(command, theme)
        given = keys(theme), keys(recipient)
        if recipient and given in self.given:
            # "Bring it to A, he ordered it": that is planned already.
            return
        self.given.append(given)
        fetcher = self.catalogue.with_role("fetch")
        if fetcher is not None and self.catalogue.with_role("grasp") is None:
            self._invoke(fetcher, replace(command, theme=theme, recipient=recipient))
            return
        name = plain(theme)
        self._get_on_board(theme, source)
        if not goal.value and keys(recipient) != keys(OPERATOR):
            self._look_for_them(recipient)
        if goal.value and goal.value != self.here and self.catalogue.mover is not None:
            self.travel(goal, f"bring {the(name)} to {self._person(recipient) if recipient else goal.label}")
        if self.holds:
            self.carried, self.holds = theme, False
        else:
            self._hand_over(theme, recipient, command)
            self.carried = ()
        self.scene.mention(recipient)
        self.scene.mention(theme)

    def _get_on_board(self, theme: Phrase, source: Place | None) -> None:
        """Be where something is and take it, unless the robot has it."""
        if keys(theme) == keys(self.carried):
            return
        if keys(theme) != keys(self.seen):
            if source is not None:
                self._stand_at(source)
            self._look_for(theme)
        self._take(theme)

    def _must_move(self, command: Command, theme: Phrase, source: Place | None) -> None:
        """For "the rubbish to the rubbish bin": what goes there is not the bin.

        Raises:
            UnclearError: Where it is is not known.
        """
        if not command.place or command.source or source is None or source.item is None:
            return
        goal = self.scene.ground(command.place).candidates[:1]
        if goal == (source.item,) and keys(theme) != keys(tokens(source.item.description)):
            raise self._unplaced(theme)

    def _unplaced(self, theme: Phrase) -> UnclearError:
        """The question where something is that is to be brought, and what the robot cannot do about it."""
        question = f"{where_is(plain(theme))}?"
        if self.catalogue.with_role("grasp", "fetch") is None:
            question = f"I cannot pick things up by myself, somebody has to put them on me. {question}"
        return UnclearError(question, about=theme)

    def _way_taken(self, command: Command) -> bool:
        """For "take the left door": a way to go."""
        way = bool(_WAYS & set(keys(command.theme)))
        leads = command.verb == "take" and way and not (command.recipient or command.place)
        if not (leads and self._grounds(command.theme)):
            return False
        self._go(replace(command, kind="motion", verb="go", place=command.theme, theme=()))
        return True

    def _taken_along(self, command: Command) -> bool:
        """For "take me to A", "take the visitors to A": leading people there."""
        if keys(command.theme) in {("me",), ("us",)} and (command.place or command.recipient):
            where = command.place or command.recipient
            self._lead(replace(command, kind="guide", theme=OPERATOR, place=where, recipient=()))
            return True
        if (
            command.place
            and self.catalogue.with_role("guide") is not None
            and self._is_company(command.theme)
        ):
            self._guide(command, bare(self.scene.referent(command.theme)))
            return True
        return False

    def _is_company(self, theme: Phrase) -> bool:
        """Whether those who are to be taken somewhere are people."""
        return self.scene.is_person(theme) or keys(theme[-1:]) in {
            ("group",),
            ("people",),
            ("party",),
            ("class",),
        }

    @abstractmethod
    def _lead(self, command: Command) -> None:
        """Lead somebody somewhere."""

    def _fetched_by_action(self, command: Command) -> bool:
        """Let an action that brings things from wherever they are do it, if nobody knows where they are."""
        fetcher = self.catalogue.with_role("fetch")
        if fetcher is None or self.catalogue.with_role("grasp") is not None or self._knows(command.theme):
            return False
        if command.source and not self._grounds(command.source) and fetcher in self.catalogue.infos:
            # "The letter from the ministry": what is on no map says which letter.
            whole = (*command.theme, *tokens("from the"), *command.source)
            command = replace(command, theme=whole, source=())
        theme = bare(self.scene.referent(command.theme))
        if command.source or self.scene.is_person(theme) or keys(theme)[:1] in {(word,) for word in ASKING}:
            return False
        recipient = command.recipient or (() if command.place else OPERATOR)
        self._invoke(fetcher, replace(command, recipient=self.scene.referent(recipient) if recipient else ()))
        return True

    def _giver(self) -> ActionInfo | None:
        """The action that hands over what the robot has on board."""
        giver = self.catalogue.with_role("handover")
        return giver or (self.catalogue.with_role("fetch") if self.catalogue.with_role("grasp") else None)

    def _knows(self, theme: Phrase) -> bool:
        """Whether it is on the map or remembered to be somewhere."""
        fact, several = find_fact(theme, self.scene.facts)
        return self._grounds(theme) or fact is not None or bool(several)

    def _from_where_it_is(self, command: Command) -> Command:
        """For "the cup on the table": taken from the table, unless that is one object of the map."""
        noun = noun_phrase(command.theme)
        if (
            command.source
            or len(noun.anchors) != 1
            or not noun.core
            or noun.relation in {"of", "with", "from"}
        ):
            return command
        if self._is_called(command.theme) or not self._grounds(noun.anchors[0]):
            return command
        size = next(
            i
            for i in range(len(command.theme))
            if keys(command.theme[i:])[: len(noun.relation.split())] == tuple(noun.relation.split())
        )
        return replace(command, theme=bare(command.theme[:size]), source=noun.anchors[0])

    def _is_called(self, theme: Phrase) -> bool:
        """Whether something on the map is called so, in one of these words: no crate is a carton of juice."""
        said = {singular(key) for key in keys(theme)}
        named = (f"{item.description} {item.class_name}" for item in self.scene.ground(theme).candidates)
        return any(said & {singular(word) for word in text.lower().split()} for text in named)

    def _theme(self, command: Command) -> tuple[Phrase, Place | None]:
        """What is to be brought, in the words it is remembered by, and where it is."""
        need = lexicon().need_phrases.get(" ".join(keys(bare(command.theme))))
        pointing = keys(command.theme) in {("it",), ("them",), ("that",), ("this",)}
        if pointing and self.carried:
            return self.carried, None
        theme = bare(self.scene.referent(tokens(need) if need else command.theme))
        if keys(theme) == keys(self.carried):
            return theme, None
        if command.source:
            return theme, self.scene.place(command.source)
        if self._grounds(theme):
            return theme, self.scene.place(theme)
        place = self.scene.remembered_place(theme)
        if place is not None and place.via is not None:
            theirs = _said_theirs(command, theme)
            if theirs and of_others(theirs, place.via.fact.subject):
                raise self._unplaced(theirs)
        if place is None and not need and self.here:
            return theme, None
        place = place or self.scene.told_place(theme) or self._place_ordered(theme)
        if place is None:
            if need:
                raise UnclearError(
                    f"I do not know of {lexicon().need_words[need]}. What should I bring, and where is it?"
                )
            raise self._unplaced(theme)
        return (place.via.fact.subject if place.via is not None and place.via.fact.subject else theme), place

    def _place_ordered(self, theme: Phrase) -> Place | None:
        """Where something was said to be looked for before ("find the A in B", then "and bring it to C")."""
        wanted = keys(bare(theme))
        for turn in reversed(self.scene.situation.history[-_TURNS:]):
            said = tokens(turn.content) if turn.role == "operator" else ()
            flat = keys(said)
            for at in (i for i in range(len(flat)) if wanted and flat[i : i + len(wanted)] == wanted):
                link = lexicon().places.match(flat, at + len(wanted))
                start = at + len(wanted) + (link[0] if link is not None else 0)
                size = map_name_end(said[start:], self.scene) if link is not None else 0
                if size:
                    return self.scene.place(said[start : start + size])
        return None

    def _destination(self, command: Command, theme: Phrase) -> tuple[Phrase, Place]:
        recipient = command.recipient
        if not recipient and not command.place and command.verb in {"take", "carry", "deliver", "transport"}:
            raise UnclearError("Where should I bring it?")
        if not recipient and not command.place:
            recipient = self.scene.persons[-1] if self.scene.persons else OPERATOR
        recipient = self.scene.referent(recipient) if recipient else ()
        unknown = recipient == OPERATOR and not command.place and not self._is_known(OPERATOR)
        if unknown and self._giver() is not None and not self.scene.hints:
            self.notes.append("I do not know where you are, so please come to me or tell me.")
            return recipient, Place("")
        if command.place:
            return recipient, self.scene.place(command.place)
        if self._just_arrived() and keys(theme) == keys(self.carried) and not self._is_known(recipient):
            return recipient, Place(self.here)
        if (
            not self._is_known(recipient)
            and not self.scene.hints
            and self._people_finder(recipient) is not None
        ):
            return recipient, Place("")
        return recipient, self._recipient_place(recipient)

    def _people_finder(self, recipient: Phrase) -> ActionInfo | None:
        """The action that finds somebody, wherever they are; None if there is none or nobody is meant."""
        finder = self._searcher(recipient) if self.scene.is_person(recipient) else None
        if finder is None or keys(recipient) == keys(OPERATOR) or self._giver() is None:
            return None
        return finder if any(parameter_role(name) == "person" for name in text_inputs(finder)) else None

    def _look_for_them(self, recipient: Phrase) -> None:
        """Find somebody of whom nobody knows where they are."""
        finder = self._people_finder(recipient)
        if finder is not None and keys(self.seen) != keys(recipient):
            self._add_look(finder, plain(recipient), f"look for {self._person(recipient)}")

    def _is_known(self, recipient: Phrase) -> bool:
        return self._grounds(recipient) or find_fact(recipient, self.scene.facts)[0] is not None

    def _person(self, recipient: Phrase) -> str:
        return "you" if keys(recipient) == ("operator",) else the(plain(recipient))

    def _look_for(self, theme: Phrase) -> None:
        looker = self._searcher(theme)
        if looker is not None:
            self._add_look(looker, plain(theme), f"look for {the(plain(theme))}")

    def _take(self, theme: Phrase) -> None:
        """Get something on board: by an action, else with the operator's help."""
        name = plain(theme)
        grasper, asker = self.catalogue.with_role("grasp"), self.catalogue.with_role("ask_operator")
        if grasper is not None:
            self.steps += self._said(grasper, name, f"take {the(name)}")
            self.will.append(f"take {the(name)}")
        elif asker is not None:
            question = f"I cannot pick things up. Please put {the(name)} on me and tell me when it is done."
            self.steps += self._said(asker, question, f"ask you to hand over {the(name)}")
            self.will.append(f"ask you to put {the(name)} on me, because I cannot pick things up")
        else:
            self.notes.append(f"I cannot pick things up, so somebody has to put {the(name)} on me.")
        self.carried = theme

    def _hand_over(self, theme: Phrase, recipient: Phrase, command: Command) -> None:
        giver = self._giver() if recipient else self.catalogue.with_role("place")
        if giver is None:
            if self.catalogue.with_role("grasp") is not None:
                deed = "hand over" if recipient else "put down"
                it = "them" if singular(theme[-1].key) != theme[-1].key else "it"
                self.notes.append(
                    f"I cannot {deed} {the(plain(theme))}, so somebody has to take {it} from me."
                )
            return
        self._invoke(giver, replace(command, theme=theme, recipient=recipient or command.recipient))

    def collect(self, command: Command) -> None:
        """Get something on board that the next clause says more about."""
        command = self._from_where_it_is(command)
        theme, source = self._theme(command)
        if self.catalogue.with_role("grasp", "ask_operator") is None:
            self.notes.append(f"I cannot pick things up, so somebody has to put {the(plain(theme))} on me.")
        if source is not None:
            self._stand_at(source)
        self._look_for(theme)
        if self.catalogue.with_role("grasp", "ask_operator") is not None:
            self._take(theme)
        self.carried = theme
        self.scene.mention(theme)

    def _grasp(self, command: Command) -> None:
        loads = command.verb.startswith("load") and {"into", "onto"} & set(keys(command.clause))
        if command.place and loads and not command.source and command.place[0].key != "your":
            # "Load A into B": taken there.
            self._fetch(replace(command, kind="transfer"))
            return
        command = self._from_where_it_is(command)
        theme = bare(self.scene.referent(command.theme)) if command.theme else ()
        if not theme:
            raise UnclearError("What should I pick up?")
        if keys(theme) in _ANYTHING and self.catalogue.with_role("grasp") is None:
            raise UnableError(f"{command.verb} {plain(theme)}")
        if self.catalogue.with_role("grasp", "ask_operator") is None:
            raise UnableError(f"pick up {the(plain(theme))}")
        place = self.scene.place(command.source) if command.source else self._known_place(theme)
        if (
            place is None
            and command.theme[0].key not in ASKING
            and not self.here
            and self.catalogue.with_role("grasp") is None
        ):
            raise self._unplaced(theme)
        self._stand_at(place)
        self._take(theme)
        self.scene.mention(theme)

    def _place(self, command: Command) -> None:
        theme = bare(self.scene.referent(command.theme)) if command.theme else self.carried
        placer, asker = self.catalogue.with_role("place"), self.catalogue.with_role("ask_operator")
        if keys(theme) != keys(self.carried):
            if keys(command.theme[:1]) in _MORE and self._known_place(command.theme) is None:
                # "Put more salt in A": nothing that lies somewhere and could be brought.
                raise UnableError(plain(command.clause))
            if command.place and theme:
                self._fetch(replace(command, kind="transfer", theme=theme))
                return
            raise UnableError(f"{command.verb} {the(plain(theme)) if theme else 'things'}")
        if not theme and placer is None:
            raise UnclearError("What should I put down?")
        command = replace(command, place=self._labelled_goal(command.place))
        if command.place:
            self._stand_at(self._place_or_here(command.place))
        if placer is None and asker is None:
            self.notes.append(f"I cannot put {the(plain(theme))} down, so somebody has to take it from me.")
        if placer is not None:
            self._invoke(placer, replace(command, theme=theme))
        elif asker is not None:
            question = f"Please take {the(plain(theme))} off me and tell me when it is done."
            self.steps += self._said(asker, question, f"ask you to take {the(plain(theme))} off me")
            self.will.append(f"ask you to take {the(plain(theme))} off me")
        self.carried = ()

    def _labelled_goal(self, place: Phrase) -> Phrase:
        """For "put it into A", where what puts things down takes a container: container A."""
        placer = self.catalogue.with_role("place")
        if placer is None or len(place) != 1 or len(place[0].key) > 1:
            return place
        kinds = [kind for name in text_inputs(placer) for kind in kinds_on_map(name, self.scene.objects)]
        called = [tokens(f"{kind} {place[0].key}") for kind in kinds]
        return next((one for one in called if self.scene.ground(one).outcome == "match"), place)

    def _stand_at_person(self, person: Phrase) -> None:
        """Go to where somebody is remembered to be."""
        fact, _ = find_fact(person, self.scene.facts)
        if fact is not None and not self.here:
            self._stand_at(self.scene.remembered_place(person))

    def _guide(self, command: Command, theme: Phrase) -> None:
        guide = self.catalogue.with_role("guide")
        if guide is None:
            raise UnableError("take people along")
        if command.source:
            self._stand_at(self.scene.place(command.source))
        self._stand_at_person(theme)
        self._invoke(guide, replace(command, kind="guide", theme=theme, recipient=theme))


def _said_theirs(command: Command, theme: Phrase) -> Phrase:
    """What is to be brought, by the name of its owner, if that was said ("take A's bag to the hall")."""
    if not command.recipient:
        return ()
    last, said = command.recipient[-1], keys(command.clause or command.words)
    if last.key.endswith("'s"):
        return (*command.recipient, *theme)
    behind = {said[i + 1] for i in range(len(said) - 1) if said[i] == last.key}
    if "'s" not in behind and f"{last.key}'s" not in said:
        return ()
    return (*command.recipient[:-1], Word(f"{last.key}'s", f"{last.raw}'s"), *theme)
