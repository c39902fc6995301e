"""The built-in engine of `--language builtin`: the interface, answered by two witnesses and one decision."""

from __future__ import annotations

import asyncio
from collections.abc import Sequence
from dataclasses import replace
from functools import lru_cache, partial
from types import TracebackType
from typing import Self

from parley.language import base
from parley.language.base import DraftHandler, Situation
from parley.language.builtin import pictures
from parley.language.builtin.addressing import uncalled
from parley.language.builtin.amending import amended
from parley.language.builtin.clauses import Clause, clauses
from parley.language.builtin.deciding import decide
from parley.language.builtin.decision import Answer, Ask, Decision, Do, Remember
from parley.language.builtin.lexicon import lexicon, stem
from parley.language.builtin.numbering import with_numbers
from parley.language.builtin.own import OwnActions, is_promised
from parley.language.builtin.own_words import own_words
from parley.language.builtin.reading import Reading, read
from parley.language.builtin.recovery import Repairer
from parley.language.builtin.reply import explained, to_chat
from parley.language.builtin.searching import searched_apart
from parley.language.builtin.skills import SkillTable
from parley.language.builtin.spans import Parse
from parley.language.builtin.steady import Names, named, steadily
from parley.language.builtin.structure import Part
from parley.language.builtin.tagger import shipped_tagger
from parley.language.builtin.things import head_of, link
from parley.language.builtin.tokens import Token, spoken, tokenize
from parley.language.dialogue.facts import in_mind
from parley.language.dialogue.following import in_turn, with_names_for_ones
from parley.language.dialogue.replies import read_reply
from parley.language.dialogue.state import Asked, Dialogue, Order
from parley.language.dialogue.teaching import founded, taught_in, with_names
from parley.messages.chat import ChatAction
from parley.messages.memory import MemoryEntry
from parley.robots.base import CameraImage
from parley.world.geometry import Pose2D
from parley.world.object_map import MapObject, ObjectMap

__all__ = ["BuiltinLanguage"]

_LONGEST = 600
_BLIND = "I cannot see what is in a picture that you send; I only keep it."


class BuiltinLanguage:
    """Understands operators' English by a small tagger and a lexicon; does only what it is certain of.

    Use as ``async with`` where a loop must not wait: the weights are loaded beside it. Without, the first
    message waits for them.
    """

    def __init__(self) -> None:
        self._lexicon = lexicon()
        self._skills: SkillTable | None = None
        self._own: OwnActions | None = None
        self._read = lru_cache(maxsize=256)(self._read_text)
        self._parts = lru_cache(maxsize=64)(self._parted)

    async def __aenter__(self) -> Self:
        await asyncio.to_thread(self.decide, Situation("is it open?"))  # reads the weights and all shapes
        return self

    async def __aexit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        """Nothing to close: the weights are the process's."""

    @property
    def label(self) -> str:
        """See `Language.label`."""
        return "built-in language engine (no language model: plain English, asks when it is not certain)"

    @property
    def sees_pictures(self) -> bool:
        """See `Language.sees_pictures`."""
        return False

    async def interpret(self, situation: Situation, *, on_draft: DraftHandler | None = None) -> ChatAction:
        """See `Language.interpret`."""
        decision = await asyncio.to_thread(self.decide, situation)
        chat = founded(self._addressed(to_chat(decision, self._lexicon), situation), situation)
        if not situation.pictures:
            return chat
        text = f"I cannot see what is in a picture. {chat.message_response}"
        return chat.model_copy(update={"message_response": text})

    def explain(self, situation: Situation) -> tuple[ChatAction, list[dict[str, str]]]:
        """See `parley.evaluation.situations.Explains`."""
        decision = self.decide(situation)
        told = explained(self._parts(situation.message), decision) if situation.message.strip() else []
        return self._addressed(to_chat(decision, self._lexicon), situation), told

    def certain(self, situation: Situation) -> ChatAction | None:
        """What a message asks for, where that is certain; None where it would be asked about or answered."""
        decision = self.decide(situation)
        if isinstance(decision, Ask) and not (decision.stops or decision.alarms):
            return None
        if isinstance(decision, Answer) and not decision.sources:
            return None
        return founded(self._addressed(to_chat(decision, self._lexicon), situation), situation)

    @staticmethod
    def _addressed(chat: ChatAction, situation: Situation) -> ChatAction:
        sent = any(picture.sent for picture in situation.pictures)
        told = f"{chat.message_response} {_BLIND}" if sent else chat.message_response
        targets = chat.targets or ((situation.robot,) if situation.robot else ())
        return chat.model_copy(update={"targets": targets, "message_response": told})

    def decide(self, situation: Situation) -> Decision:
        """What comes of a message."""
        if len(situation.message) > _LONGEST:
            return Ask("That is too much at once. Please say it in shorter pieces.")
        if not any(token.is_word for token in tokenize(situation.message)):
            return Ask("I did not understand that. Please say what I should do.")
        names = _names(tuple(item.description for item in situation.objects))
        situation = replace(situation, message=self._meant(uncalled(situation, self._lexicon), names))
        said = with_numbers(in_turn(situation.message), situation.places)
        said = searched_apart(said, situation.places, situation.rooms)
        situation = replace(situation, message=said)
        situation = self._with_past(replace(situation, message=with_names_for_ones(situation)))
        situation = replace(situation, memory=(*situation.memory, *in_mind(situation)))
        if (taught := own_words(situation, self._lexicon, self.decide)) is not None:
            return taught
        situation = replace(situation, objects=with_names(situation.objects, taught_in(situation.memory)))
        parts = self._parts(situation.message, names)
        if len(parts) > 1 and is_promised(situation.message, situation.catalogue):
            parsed, _ = self._read(situation.message, names)
            parsed = replace(parsed, acts=("order",) * len(parsed.tokens))  # its maker's words for it
            reading = read(parsed, self._lexicon)
            whole = Clause("main", 0, len(parsed.tokens), 0)  # "open the door to the yard" is one deed there
            parts = (Part(whole, parsed, reading, situation.message),)
        if self._skills is None or self._own is None:
            self._skills = SkillTable(shipped_tagger(), self._lexicon)
            self._own = OwnActions(shipped_tagger(), self._lexicon)
        skills = self._skills.of(situation.catalogue)
        framed = frozenset(skill.action.name for skill in skills.values())
        own, known = self._own.applied, situation.catalogue
        parts = tuple(
            replace(one, reading=own(one.parse, one.reading, known, framed))
            if one.clause.link == "main" and one.parse.tokens and one.reading.acts != {"answer"}
            else one
            for one in parts
        )

        def again(text: str, without: Sequence[str] = (), told: Sequence[MemoryEntry] = ()) -> Decision:
            objects = tuple(item for item in situation.objects if item.description not in without)
            plain = replace(situation.dialogue, asked=None)  # it is no answer to what was asked about it
            memory = (*situation.memory, *told)
            return self.decide(
                replace(situation, message=text, history=(), objects=objects, dialogue=plain, memory=memory)
            )

        made = decide(situation, parts, skills, self._lexicon, partial(self.reading, names=names), again)
        said = situation.message  # "Ada, Kim's box is here" tells nothing of Ada
        bare = uncalled(situation, self._lexicon, told=True) if isinstance(made, Remember) else said
        return self.decide(replace(situation, message=bare)) if bare != said else made

    def _with_past(self, situation: Situation) -> Situation:
        """With the last order and what was asked about it, where nothing but the turns is known of them."""
        past = next((turn.content for turn in reversed(situation.history) if turn.role == "operator"), "")
        if not past or situation.dialogue.now_unix_ms or situation.queue or situation.question:
            return situation
        made = self.decide(replace(situation, message=past, history=()))
        calls = to_chat(made, self._lexicon).queue if isinstance(made, Do) else ()
        asks = isinstance(made, Ask) and (made.choices or made.where or made.alarms)
        dialogue = Dialogue(
            asked=Asked(made.about or past, made.choices, made.where, made.alarms)
            if isinstance(made, Ask) and asks
            else None,
            orders=(Order(past, calls=calls),) if calls else (),
            waiting=(past,) if isinstance(made, Answer) and made.waits else (),
            told=tuple(fact.text for fact in made.told) if isinstance(made, Ask) else (),
        )
        return replace(situation, dialogue=dialogue)

    def reading(self, text: str, names: Names = ()) -> Reading:
        """What a text says, whatever the situation but for the names that are known in it."""
        return self._read(self._meant(text, names), names)[1]

    def _meant(self, text: str, names: Names) -> str:
        """A text without what is taken back in it: nothing that follows sees what is not meant."""
        while (cut := amended(self._read(text, names)[0], self._lexicon)) is not None:
            text = f"{text[: cut[0]]}{text[cut[1] :]}"
        return text

    def _read_text(self, text: str, names: Names = ()) -> tuple[Parse, Reading]:
        tokens = spoken(tokenize(text)) or tokenize(text)
        found = self._steadily(tokens, names)
        if not (found[1].unsteady or found[1].left_over):
            return found
        stop = Token(".", tokens[-1].end, tokens[-1].end)  # it helps with names that nobody knows
        other = self._steadily((*tokens, stop), names)
        certain = other[1].wishes and not (other[1].unsteady or other[1].left_over)
        return other if certain else found

    def _steadily(self, tokens: Sequence[Token], names: Names) -> tuple[Parse, Reading]:
        """What words say; where a known name is what is doubtful, with each name read as one word."""
        found = steadily(shipped_tagger(), tokens, self._lexicon)
        spans = named(tokens, names)
        inside = {at for start, end in spans for at in range(start, end)}
        fillers = [*found[1].loose, *(filler for wish in found[1].wishes for filler in wish.fillers)]
        edges = {edge for filler in fillers for edge in (filler.start, filler.end)}
        torn = any(start < edge < end for start, end in spans for edge in edges)
        if not torn and inside.isdisjoint(_doubtful(tokens, found[1])):
            return found
        other = steadily(shipped_tagger(), tokens, self._lexicon, names)
        return found if not other[1].wishes or _doubtful(tokens, other[1]) else other

    def _parted(self, text: str, names: Names = ()) -> tuple[Part, ...]:
        """The clauses of a message, each read by itself."""
        parsed, reading = self._read(text, names)
        found = clauses(parsed, self._lexicon)
        if len(found) == 1:
            return (Part(found[0], parsed, reading, text),)
        return tuple(self._part(text, clause, parsed, names) for clause in found)

    def _part(self, text: str, clause: Clause, whole: Parse, names: Names) -> Part:
        tokens = whole.tokens[clause.start : clause.end]
        if not tokens:
            nothing = Parse((), (), (), (), ())
            return Part(clause, nothing, Reading(frozenset(), (), (), ()), "")
        parsed, reading = self._steadily(tokens, names)
        if not parsed.verbs and any(clause.start <= verb.start < clause.end for verb in whole.verbs):
            parsed = whole.part(clause.start, clause.end)
            reading = read(parsed, self._lexicon)
        return Part(clause, parsed, reading, text[tokens[0].start : tokens[-1].end])

    async def select_memories(self, query: str, index: Sequence[MemoryEntry]) -> list[str]:
        """See `Language.select_memories`; those that share a word with one that was found matter, too."""
        known = [self._content(f"{item.name.replace('_', ' ')} {item.info} {item.data}") for item in index]
        wanted = self._content(query)
        wanted = wanted.union(*(words for words in known if words & wanted))
        return [item.name for item, words in zip(index, known, strict=True) if words & wanted]

    def _content(self, text: str) -> set[str]:
        classes = self._lexicon.classes
        empty = classes["small"] | classes["prepositions"] | classes["determiners"]
        return {stem(token.low) for token in tokenize(text) if token.is_word and token.low not in empty}

    async def resolve(self, situation: base.ErrorSituation) -> ChatAction:
        """See `Language.resolve`."""
        repairer = Repairer(self._lexicon, self.decide, self.reading)
        return await asyncio.to_thread(repairer.resolve, situation)

    async def ground(
        self, description: str, objects: Sequence[MapObject], pose: Pose2D | None = None
    ) -> base.Grounding:
        """See `Language.ground`."""
        words = [token.low for token in tokenize(description) if token.is_word]
        if not words:
            return base.Grounding("none")
        exact = [
            item
            for item in objects
            if description.strip().lower() in (item.description.lower(), item.id.lower())
        ]
        if len(exact) == 1:
            return base.Grounding("match", tuple(exact))
        found = link(words, head_of(words, self._lexicon), objects, self._lexicon)
        kinds = {"one": "match", "several": "ambiguous"}
        outcome = kinds.get(found.kind)
        if outcome == "match":
            return base.Grounding("match", found.things)
        return base.Grounding("ambiguous", found.things) if outcome else base.Grounding("none")

    async def inspect(
        self, image: CameraImage, request: str, rules: Sequence[str] = (), known: ObjectMap | None = None
    ) -> base.InspectionReport:
        """See `Language.inspect`."""
        return pictures.inspect(image, request, known)

    async def read_reply(self, question: str, reply: str, choices: Sequence[str] = ()) -> base.ReplyReading:
        """See `Language.read_reply`."""
        said = any(token.is_word for token in tokenize(reply))
        return read_reply(question, reply, choices, self.reading(reply) if said else None)


def _doubtful(tokens: Sequence[Token], reading: Reading) -> set[int]:
    """Where words stand that the tagger is not sure of, that are left over, or are unknown verbs."""
    words = {word.lower() for text in (*reading.unsteady, *reading.left_over) for word in text.split()}
    verbs = {wish.start for wish in reading.wishes if wish.witness == "unknown"}
    return verbs | {at for at, token in enumerate(tokens) if token.low in words}


@lru_cache(maxsize=64)
def _names(called: tuple[str, ...]) -> Names:
    """The names of several words among those that are known; what ends in a number or letter is read well."""
    found = {tuple(token.low for token in tokenize(name)) for name in called}
    several = [name for name in found if len(name) > 1 and len(name[-1]) > 1 and name[-1].isalpha()]
    return tuple(sorted(several, key=lambda name: (-len(name), name)))
