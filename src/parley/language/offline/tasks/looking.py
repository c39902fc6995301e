"""Steps that look at something or for something."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

from parley.language.offline.facts.facts import NO_PLACES
from parley.language.offline.scene.grounding import describe, ground_phrase
from parley.language.offline.scene.placing import PARTS
from parley.language.offline.scene.scene import Place, UnclearError
from parley.language.offline.tasks.catalogue import parameter_role, text_inputs
from parley.language.offline.tasks.commands import Command
from parley.language.offline.tasks.docking import Docking
from parley.language.offline.tasks.going import FORWARD, UnableError
from parley.language.offline.words.lexicon import lexicon
from parley.language.offline.words.naming import name_words
from parley.language.offline.words.nouns import NounPhrase, bare, noun_phrase
from parley.language.offline.words.saying import the
from parley.language.offline.words.text import Phrase, Word, keys, plain, singular, tokens
from parley.language.word_lists import load_data
from parley.messages.status import ActionInfo

__all__ = ["ASKING", "Looking"]

ASKING = frozenset({"it", "that", "this", "them", "there", "here", "those", "these"})
"""Words that point at something said before."""


def _start_of(flat: tuple[str, ...], relation: str) -> int:
    wanted = tuple(relation.split())
    return next((i for i in range(len(flat)) if flat[i : i + len(wanted)] == wanted), len(flat))


_PICTURES = frozenset({"picture", "pictures", "photo", "photos", "photograph", "image", "snapshot", "pic"})
_UNSEEN = frozenset(load_data("incidents")["unseen"])
_REACH_M = 1.5
"""How far from a place things may be that are said to be there."""
_SOMEBODY = frozenset({("he",), ("she",)})
_ANYONE = frozenset({("anyone",), ("anybody",), ("someone",), ("somebody",)})
_PLAIN_LOOKS = frozenset({"check", "look", "inspect", "examine", "have a look", "take a look"})
_HIDDEN_SIDES = frozenset({"behind", "under", "beneath", "underneath", "below"})
_GENERAL = frozenset((word,) for word in (
    "things", "everything", "stuff", "anyone", "anybody", "someone", "somebody", "nobody", "everyone",
    "everybody", "anything", "something", "nothing", "all",
))  # fmt: skip


def _without_article(words: Phrase) -> Phrase:
    return words[1:] if keys(words[:1]) in {("the",), ("a",), ("an",)} else words


def _in_general(command: Command) -> bool:
    """Whether it is about no thing in particular ("whether anyone is there")."""
    return command.kind == "whether" and keys(bare(command.theme)) in _GENERAL


def _of_one(member: Phrase, command: Command) -> Command:
    """For one of several of which something is to be checked ("whether all boxes are shut")."""
    link = next((i for i, word in enumerate(command.words) if word.key in {"are", "is", "were", "was"}), 0)
    if command.kind != "whether" or not link:
        return command
    verb = {"are": "is", "were": "was"}.get(command.words[link].key, command.words[link].key)
    named = tokens(the(plain(member)))
    much = command.verb.endswith("how") and command.words[0].key not in lexicon().determiners
    lead = command.words[:1] if much and command.words[0] not in command.theme else ()
    words = (*lead, *named, Word(verb, verb), *command.words[link + 1 :])
    return replace(command, theme=member, words=words)


@dataclass
class Looking(Docking):
    """How to look at things and for things."""

    def _look(self, command: Command) -> None:
        looker = self._looker(command)
        if looker is None:
            raise UnableError(f"{command.verb} things")
        unplaced = _in_general(command) and not command.place and not noun_phrase(command.words).anchors
        if unplaced and (done_to := self._done_to(command)):
            self._look_there(replace(command, place=done_to), looker)
            return
        if unplaced:
            # "The hall. Is anyone there?"
            if not self.here and self.scene.places:
                self._stand_at(self.scene.place(self.scene.places[-1]))
            request = self._whether(command)
            self._add_look(looker, request, f"check {request}")
            return
        pointed = keys(command.words[-1:]) in {("there",), ("here",)} and not command.place
        last = bare(command.theme)[-1:]
        unlike = "are" in keys(command.words) and last and singular(last[0].key) == last[0].key
        # "See if the towels are there, then A": A takes the place of the towels, and is gone to.
        pointed = pointed and not (unlike and self._strictly(command.theme))
        if self.here and pointed and command.kind == "whether" and bare(command.theme):
            # "Go to A and see if B is there", wherever B is on the map.
            request = self._whether(command)
            self.scene.mention(bare(self.scene.referent(command.theme)))
            self._add_look(looker, request, f"check {request}")
            return
        at_hand = self.here and command.kind == "whether"
        elsewhere = any(self._strictly(anchor) for anchor in noun_phrase(command.words).anchors)
        at_hand = at_hand and not elsewhere and not self._grounds(command.place)
        if at_hand and self._only_described(command.theme):
            # "Whether there is diesel on the ground", where a tank for it is on the map: here.
            request = self._whether(command)
            self._add_look(looker, request, f"check {request}")
            return
        if command.place:
            self._look_there(command, looker)
            return
        if self._turns_camera(command.theme):
            raise UnableError("turn my camera")
        if not command.theme:
            self._look_anywhere(command, looker)
            return
        inner = self._inside(command)
        if inner is not None:
            self._look_there(inner, looker)
            return
        members = self.scene.several(command.theme)
        for member in members:
            self._look_at(member, _of_one(member, command) if len(members) > 1 else command, looker)

    def _look_anywhere(self, command: Command, looker: ActionInfo) -> None:
        """Look where nothing says at what: here, or at the place that was spoken of."""
        looked = any(step.name == looker.name for step in self.steps[-2:]) and command.verb != "look around"
        if command.kind == "look" and looked:
            # "Something fell off the shelf, please have a look": that is planned already.
            return
        if not self.here and self.scene.places:
            self._stand_at(self.scene.place(self.scene.places[-1]))
            place = self.scene.places[-1]
            self._add_look(looker, plain(place), f"look at {the(plain(place))}")
            return
        request = "whether " + plain(command.words) if command.kind == "whether" else "what can be seen"
        here = self.here if command.kind == "look" and command.verb in _PLAIN_LOOKS else ""
        self._add_look(looker, here or request, f"look at {the(here)}" if here else "look around")

    def _done_to(self, command: Command) -> Phrase:
        """For "whether anything is blocking A": A, if it is on the map; empty otherwise."""
        words = command.words
        before = (i for i in range(2, len(words)) if words[i - 1].key.endswith(("ing", "s", "ed")))
        starts = (i for i in before if words[i - 1].key not in lexicon().be)
        named = (bare(words[i:]) for i in starts)
        return next((one for one in named if one and self._strictly(one)), ())

    def _strictly(self, words: Phrase) -> bool:
        return ground_phrase(words, self.scene.objects, strict=True).outcome == "match"

    def _turns_camera(self, theme: Phrase) -> bool:
        """Whether only a direction is to be looked in ("look up")."""
        forward = bool(theme) and len(theme) < 3 and bool(set(keys(theme)) & FORWARD)
        return forward and not self._grounds(theme[:1])

    def _only_described(self, theme: Phrase) -> bool:
        """Whether what is looked for only describes something else on the map ("diesel", "diesel tank")."""
        last = keys(bare(theme))[-1:]
        if len(bare(theme)) != 1 or not self._grounds(theme) or last[0].isdigit() or len(last[0]) == 1:
            return False
        found = ground_phrase(theme, self.scene.objects, strict=True)
        return found.outcome == "none" or self.scene.is_part(bare(theme)[-1])

    def _looker(self, command: Command) -> ActionInfo | None:
        """The action to look with: one that is called like the verb, for pictures one that takes them."""
        if self._only_found(command):
            return self._searcher(command.theme)
        lookers = self.catalogue.all_with_role("look")
        pictures = bool(_PICTURES & set(keys(command.clause[:4])) or _PICTURES & set(command.verb.split()))
        taking = [info for info in lookers if _PICTURES & set(name_words(info.name))]
        others = [info for info in lookers if info not in taking]
        named = (i for i in others if name_words(i.name)[:1] == tuple(command.verb.split()[:1]))
        if pictures and taking:
            return taking[0]
        return next(named, None) or next(iter([*others, *taking]), None) or self.catalogue.with_role("search")

    def _inside(self, command: Command) -> Command | None:
        """For "count the cups on the table": at the table, look for the cups; "the A door": at A."""
        whole = self._part_of(bare(command.theme))
        if whole:
            return replace(command, place=whole)
        if command.kind == "whether":
            subject = keys(bare(command.theme))
            known = self._grounds(command.theme) and not _in_general(command)
            placed = noun_phrase(command.theme)
            known = known and not self._elsewhere(placed) and not self._only_described(command.theme)
            if (known and not self._may_have_gone(command)) or (subject and subject[0] in ASKING):
                return None
            noun = placed if len(placed.anchors) == 1 else noun_phrase(command.words)
        else:
            noun = noun_phrase(command.theme)
            counted = {"count", "many", "number"} & set(command.verb.split()) and not self._is_kind(
                noun.core[-1:]
            )
            found = self.scene.ground(command.theme).outcome != "none"
            if found and not counted and not self._elsewhere(noun):
                return None
        if len(noun.anchors) != 1 or noun.relation in {"with", "from"} or not noun.core:
            return None
        if noun.relation == "of" and not self.scene.far_from(noun.core, noun.anchors[0]):
            return None
        if keys(noun.anchors[0])[:1] and keys(noun.anchors[0])[0] in NO_PLACES:
            # "The shelves are in place": how they are, not where.
            return None
        if self.scene.ground(noun.anchors[0]).outcome == "none":
            return None
        theme = bare(command.theme[: _start_of(keys(command.theme), noun.relation)])
        return replace(command, theme=theme, place=noun.anchors[0])

    def _may_have_gone(self, command: Command) -> bool:
        """For "whether the van is still in the yard": the yard is looked at, for that is what is asked."""
        noun = noun_phrase(command.words)
        if noun.relation not in {"in", "inside", "at"} or len(noun.anchors) != 1:
            return False
        there = ground_phrase(noun.anchors[0], self.scene.objects, strict=True)
        return there.outcome == "match" and "still" in keys(command.words)

    def _is_read_there(self, command: Command) -> bool:
        """Whether "read A" is a look at A; "read N a story" is none."""
        flat = keys(command.theme)
        at = next((i for i in range(1, len(flat)) if flat[i] in lexicon().determiners), 0)
        if command.verb != "read" or (
            at > 0 and flat[0] != "me" and self.scene.is_person(command.theme[:at])
        ):
            return False
        return bool(self.here or self._grounds(command.theme[-2:]))

    def _part_of(self, theme: Phrase) -> Phrase:
        """What a part of something belongs to that is on the map only as a whole ("the A door")."""
        if len(theme) < 2 or singular(theme[-1].key) not in PARTS or self._grounds(theme):
            return ()
        last = theme[-2]
        whole = (*theme[:-2], Word(last.key.removesuffix("'s"), last.raw.removesuffix("'s")))
        return whole if self.scene.ground(whole).outcome == "match" else ()

    def _elsewhere(self, noun: NounPhrase) -> bool:
        """Whether all things on the map that are called so are far from where these are said to be."""
        near = len(noun.anchors) == 1 and noun.relation in {"in", "at", "inside", "within", "of"}
        return near and self.scene.far_from(noun.core, noun.anchors[0])

    def _is_kind(self, core: tuple[str, ...]) -> bool:
        """Whether things of the map are called so, as against "toys" where there is a "toy box"."""
        kind = {singular(word) for word in core}
        called = ((item.class_name, item.description.split()[-1:]) for item in self.scene.objects)
        return any(kind & {singular(word.lower()) for word in (name, *last)} for name, last in called)

    def _look_there(self, command: Command, looker: ActionInfo) -> None:
        """Something in or at a place: "the shelf for leaks", "whether the cup is on the table"."""
        meant = self._meant_for(command)
        if meant:
            self._look_at(meant, replace(command, theme=meant, place=()), looker)
            return
        members = self.scene.several(command.place)
        if len(members) > 1 and self.scene.ground(command.place).outcome != "match":
            for member in members:
                self._look_there(replace(command, place=member), looker)
            return
        there = keys(command.words[:1]) == ("there",) and self._grounds(command.place)
        whole = command.kind == "whether" and self._strictly(command.theme) and not _in_general(command)
        whole = whole and not there and not self._said_to_be(command)
        whole = whole and not self.scene.far_from(keys(bare(command.theme)), command.place)
        stand = self._place_or_here(command.theme if whole else command.place)
        theme = plain(self.scene.referent(command.theme)) if command.theme else ""
        request = self._whether(command) if command.kind == "whether" else theme
        self._stand_at(stand)
        if command.kind == "look" and stand is not None and self._not_seen(theme, looker):
            # "Noises from A", where all there is to look with takes pictures: of A.
            self._add_look(looker, stand.value, f"look at {the(stand.value)}")
            return
        self.scene.mention(bare(command.theme))
        if command.kind == "whether":
            found = "look for" if self._only_found(command) else "check"
            self._add_look(looker, request, f"{found} {request}")
        else:
            self._add_look(looker, request or command.verb, f"look for {self._named(theme)}")

    @staticmethod
    def _not_seen(theme: str, looker: ActionInfo) -> bool:
        """Whether what is sought is no sight, for an action that takes a picture of what it is given."""
        takes = bool(_PICTURES & set(name_words(looker.name)))
        return takes and bool(_UNSEEN & {singular(word) for word in theme.lower().split()})

    def _meant_for(self, command: Command) -> Phrase:
        """For "check the shelf for A" the one of several shelves that is remembered to be for A."""
        if (
            command.kind != "look"
            or not command.theme
            or self.scene.ground(command.place).outcome != "ambiguous"
        ):
            return ()
        told = self.scene.told_apart((*bare(command.place), Word("for", "for"), *command.theme))
        return tokens(describe(told, self.scene.objects)) if told is not None else ()

    def _said_to_be(self, command: Command) -> bool:
        """For "whether A is on B": it is at B that this can be seen, for A may be anywhere."""
        flat = keys(command.words)
        link = next((i for i in range(1, len(flat)) if flat[i] in lexicon().be), len(flat))
        start = link + 1 + (flat[link + 1 : link + 2] in {("still",), ("already",), ("really",)})
        found = lexicon().places.match(flat, start) if start < len(flat) else None
        return found is not None and keys(bare(command.words[start + found[0] :])) == keys(command.place)

    def _named(self, theme: str) -> str:
        """With its article, but "cracks" and "all the cups" as they are."""
        words = theme.split()
        plural = bool(words) and singular(words[-1].lower()) != words[-1].lower()
        return theme if plural or (" " in theme and words[0].lower() in lexicon().numbers) else the(theme)

    def _look_at(self, member: Phrase, command: Command, looker: ActionInfo) -> None:
        if command.kind == "whether":
            request = self._whether(command)
            if keys(command.words)[-1:] != ("there",) or not self._stands_here(member):
                # "Whether A is in its place there" is seen from where it ought to be.
                self._stand_at(self._place_or_here(member))
            self.scene.mention(bare(self.scene.referent(member)))
            self._add_look(looker, request, f"check {request}")
            return
        place = self._place_or_here(member)
        name = plain(bare(self.scene.referent(member)))
        owned = " of " in f" {name.lower()} " or "'s " in name
        part = owned and self.scene.whole(tokens(name)) is not None
        exact = place is not None and place.item is not None and place.via is None and not part
        request = place.value if place is not None and exact else name
        side = command.verb.removeprefix("look ")
        if side in _HIDDEN_SIDES and command.verb != side:
            request = f"{side} {the(request)}"
            self._stand_at(place)
            self._add_look(looker, request, f"look {request}")
            return
        self._stand_at(place)
        self._add_look(looker, request, f"look at {the(request)}")

    def _stands_here(self, member: Phrase) -> bool:
        """Whether something is on the map where the robot is by then."""
        here = ground_phrase(tokens(self.here), self.scene.objects, strict=True) if self.here else None
        if here is None or here.outcome != "match":
            return False
        place, items = here.candidates[0], self.scene.ground(member).candidates
        reach_m = _REACH_M + math.hypot(place.width_m, place.height_m) / 2
        return bool(items) and all(
            math.hypot(item.x_m - place.x_m, item.y_m - place.y_m) <= reach_m for item in items
        )

    def _only_found(self, command: Command) -> bool:
        """Whether the robot can only find people, and it comes to that ("if A is in B", "B for A")."""
        looks = command.kind == "whether" or (command.kind == "look" and command.place)
        if not looks or self.catalogue.with_role("look") is not None:
            return False
        found = self._searcher(command.theme) if command.theme and self._is_somebody(command.theme) else None
        return found is not None and "person" in {parameter_role(name) for name in text_inputs(found)}

    def _whether(self, command: Command) -> str:
        if self._only_found(command):
            return plain(bare(self.scene.referent(command.theme)))
        words, asking = command.words, "how" if command.verb.endswith("how") else "whether"
        somebody = keys(command.theme) in _SOMEBODY and bool(self.scene.persons)
        if asking == "how" and keys(command.theme) == ("it",) and command.place:
            # "How warm it is in A": "it" is nothing.
            return f"{asking} {plain(words)}"
        if somebody or (command.theme and keys(bare(command.theme))[0] in ASKING):
            subject = the(plain(self.scene.referent(command.theme)))
            size = len(command.theme)
            starts = (i for i in range(len(words)) if keys(words[i : i + size]) == keys(command.theme))
            at = next(starts, 0)
            return " ".join(f"{asking} {plain(words[:at])} {subject} {plain(words[at + size :])}".split())
        return f"{asking} {plain(words)}"

    def _add_look(self, looker: ActionInfo, request: str, saying: str) -> None:
        self._sharpen_look(looker, request)
        added = self._said(looker, request, saying)
        same = [step.input_parameters for step in self.steps[-len(added) :]]
        if same != [step.input_parameters for step in added] or self.steps[-1].name != looker.name:
            self.steps += added
            self.will.append(saying)

    def _sharpen_look(self, looker: ActionInfo, request: str) -> None:
        """Take back a mere look at the place when the next order says what to look for there."""
        last = self.steps[-1] if self.steps else None
        if last is None or not self.here or last.name != looker.name or last.flow is not None:
            return
        asked = {str(parameter.value).lower() for parameter in last.input_parameters.values()}
        mere = asked == {self.here.lower()} and self.will[-1:] == [f"look at {the(self.here)}"]
        if mere and not self._grounds(tokens(request)):
            del self.steps[-1], self.will[-1]

    def _search(self, command: Command) -> None:
        command = self._where_last_said(self._searched_for(command))
        # "Check that A is in its place. If not, look for it at B": "it" may be what it stands at.
        elsewhere = command.place and not self.seen
        theme = self._wanted(command.theme, plain(bare(command.place)) if elsewhere else self.here)
        searcher = self._searcher(theme)
        if searcher is None:
            raise UnableError("look for things")
        words = plain(theme)
        if command.place:
            self._stand_at(self._place_or_here(command.place))
            if keys(theme) == ("operator",) and self.catalogue.with_role("meet") is None:
                # "Meet me at the desk": being there is all.
                return
        else:
            own = "search" in self.catalogue.roles(searcher)
            sent = self._just_arrived() and command.verb.startswith("look") and not self._grounds(theme)
            said = keys(command.clause)[-1:] == ("there",) or self._at_large(theme)
            # "Rubbish" is no rubbish bin, which only is called after it.
            said = said or self._only_described(theme)
            here = self.here and (said or sent)
            known = None if here else self._known_place(theme)
            if known is not None:
                self._stand_at(known)
                if known.via is not None:
                    words = (
                        plain(known.via.fact.subject) if len(known.via.fact.subject) > len(theme) else words
                    )
            elif not (own or self.here):
                raise UnclearError(f"Where should I look for {the(words)}?", about=theme)
        self.scene.mention(theme)
        if self._is_somebody(theme) and keys(self.scene.persons[-1] if self.scene.persons else ()) != keys(
            theme
        ):
            self.scene.persons.append(theme)
        self.seen = theme
        self._add_look(searcher, words, f"look for {the(words)}")

    def _searched_for(self, command: Command) -> Command:
        """For "search the hall for a key": where, and what."""
        flat = keys(command.theme)
        at = flat.index("for", 1) if "for" in flat[1:-1] else 0
        if not at or command.place or not self._grounds(command.theme[:at]) or self._grounds(command.theme):
            return command
        theme = bare(command.theme[at + 1 :])
        return replace(command, place=bare(command.theme[:at]), theme=theme, words=theme)

    def _where_last_said(self, command: Command) -> Command:
        """For "the person in the red coat in the hall": where is what is said last and is on the map."""
        if command.place and self._grounds(command.place):
            return command
        words = tuple(word for word in command.words if word.is_word)
        flat = keys(words)
        if not command.place and not self.scene.is_person(words):
            return command
        for at in range(len(flat) - 2, 0, -1):
            found = lexicon().places.match(flat, at)
            rest = (
                words[at + found[0] :] if found is not None and found[1] not in {"of", "with", "from"} else ()
            )
            if rest and self._grounds(rest) and not self._grounds(words):
                return replace(command, theme=_without_article(words[:at]), place=bare(rest))
        return command

    def _searcher(self, theme: Phrase) -> ActionInfo | None:
        wanted = "person" if self._is_somebody(theme) else "object"
        for info in (*self.catalogue.all_with_role("search"), *self.catalogue.all_with_role("meet")):
            roles = {parameter_role(name) for name in text_inputs(info)}
            if wanted in roles or not roles & {"person", "object"}:
                return info
        return self.catalogue.with_role("look") or self.catalogue.with_role("search")

    def _is_somebody(self, theme: Phrase) -> bool:
        core = noun_phrase(theme).core
        named = bool(core) and core[-1] in lexicon().person_words
        return named or keys(theme) in _ANYONE or self.scene.is_person(theme)

    def _wanted(self, theme: Phrase, where: str) -> Phrase:
        if not theme:
            raise UnclearError("What should I look for?")
        meant = bare(self.scene.referent(theme))
        if keys(bare(theme)) == ("it",) and where and plain(meant).lower() == where.lower():
            # "Go to the desk and look for it": not for the desk.
            others = [t for t in self.scene.things if plain(bare(t)).lower() != where.lower()]
            meant = bare(others[-1]) if others else meant
        return meant

    def _at_large(self, theme: Phrase) -> bool:
        """Whether any things of a kind are looked for, of which the map has one by another name."""
        last = keys(bare(theme))[-1:]
        if not last or singular(last[0]) == last[0] or (theme and theme[0].key in {"the", "my", "our"}):
            return False
        items = self.scene.ground(theme).candidates
        return bool(items) and not any(singular(last[0]) in i.description.lower().split() for i in items)

    def _known_place(self, theme: Phrase) -> Place | None:
        if self._grounds(theme):
            return self.scene.place(theme)
        place = self.scene.remembered_place(theme)
        return place if place is not None else self.scene.told_place(theme)
