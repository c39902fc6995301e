"""Bringing somewhere what the robot pulls: it is coupled, and let go of where it is to be."""

from __future__ import annotations

from dataclasses import dataclass

from parley.language.offline.tasks.catalogue import call, text_inputs
from parley.language.offline.tasks.commands import Command
from parley.language.offline.tasks.own_kind import OwnKind
from parley.language.offline.tasks.stand_ins import kinds_on_map
from parley.language.offline.words.naming import name_words
from parley.language.offline.words.nouns import bare
from parley.language.offline.words.saying import the
from parley.language.offline.words.text import Phrase, keys, plain, singular, tokens
from parley.language.word_lists import load_data
from parley.messages.status import ActionInfo

__all__ = ["Towing"]

_COUPLING = frozenset(load_data("names")["coupling"])
_UNCOUPLING = frozenset(load_data("names")["uncoupling"])


@dataclass
class Towing(OwnKind):
    """How to bring things that are coupled to the robot."""

    def _tow(self, command: Command) -> bool:
        """Bring something that an action of this robot couples to where it is to go, if that is asked."""
        if command.kind != "transfer" or not command.place or not command.theme:
            return False
        theme = bare(self.scene.referent(command.theme))
        coupler = self._coupler(theme)
        if coupler is None or not self._grounds(command.place):
            return False
        name, value = text_inputs(coupler)[0], self._called(theme)
        coupled = any(
            step.name == coupler.name and step.input_parameters[name].value == value for step in self.steps
        )
        if not coupled:
            self.steps.append(call(coupler, {name: value}, plain(command.clause)))
            self.will.append(f"couple {the(value)}")
        self.travel(self.scene.place(command.place), f"bring {the(value)} to {the(plain(command.place))}")
        release = None if coupled else self._releaser()
        if release is not None:
            values = dict.fromkeys(text_inputs(release), value)
            self.steps.append(call(release, values, plain(command.clause)))
            self.will.append(f"let go of {the(value)} there")
        self.carried = ()
        self.scene.mention(tokens(value))
        return True

    def _coupler(self, theme: Phrase) -> ActionInfo | None:
        """The action that couples a thing of the map; None if there is none."""
        items = self.scene.ground(theme).candidates
        kinds = {singular(word) for item in items[:1] for word in name_words(item.class_name)}
        for info in self.catalogue.of_own_kind:
            texts = text_inputs(info)
            couples = name_words(info.name)[0] in _COUPLING and len(info.inputs) == len(texts) == 1
            if couples and kinds & set(kinds_on_map(texts[0], self.scene.objects)):
                return info
        return None

    def _releaser(self) -> ActionInfo | None:
        """The action that lets go of what is coupled."""
        infos = (info for info in self.catalogue.infos if name_words(info.name)[0] in _UNCOUPLING)
        return next((i for i in infos if len(i.inputs) == len(text_inputs(i)) < _TWO), None)

    def _released_already(self, command: Command) -> bool:
        """For "bring it to A and release it there", where what was brought is let go of already."""
        info, last = self._releaser(), self.steps[-1:]
        said = set(keys(command.clause[:1])) & _UNCOUPLING or command.kind == "place"
        return bool(said and info is not None and last and last[0].name == info.name)


_TWO = 2
