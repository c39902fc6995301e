"""What a message asks for: the way from words to a Chat Action."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

from parley.language.base import Situation
from parley.language.control import control_of
from parley.language.offline import addressing, social
from parley.language.offline.abilities import abilities, cannot
from parley.language.offline.answering import Answering
from parley.language.offline.changing import CONTROL_REPLIES
from parley.language.offline.clauses import Clause, clauses, opens_command
from parley.language.offline.commands import Command, read_command
from parley.language.offline.facts import Fact, read_statement, strip_openers
from parley.language.offline.followup import pending_request
from parley.language.offline.lexicon import lexicon
from parley.language.offline.mending import mended
from parley.language.offline.nouns import bare, noun_phrase
from parley.language.offline.remembering import find_fact
from parley.language.offline.replanning import inserted, read_replanning
from parley.language.offline.saying import listing, the, whole_sentence
from parley.language.offline.scene import Scene, UnclearError
from parley.language.offline.stories import mentioned, told_around
from parley.language.offline.tasks import UnableError
from parley.language.offline.text import Phrase, Word, keys, plain, tokens
from parley.language.offline.wishes import due, missing, need, wish
from parley.messages.chat import ActionCall, ChatAction, Flow, FlowIf, SystemCommand

__all__ = ["interpret"]

_LONGEST_CHARS = 6000


def interpret(situation: Situation) -> ChatAction:
    """Understand one message."""
    message = situation.message.strip()
    if not any(char.isalnum() for char in message):
        return _say(situation, "I did not get any words. What can I do for you?")
    if len(message) > _LONGEST_CHARS:
        return _say(situation, "That is too long for me to follow. Please tell me in a few short sentences.")
    control = control_of(message, situation.robots)
    if control is not None:
        command, reply = CONTROL_REPLIES[control]
        return _say(situation, reply, commands=(SystemCommand(command=command),))
    words = mended(tokens(message), situation)
    own = addressing.own_part(words, situation)
    if own is not None:
        mine = interpret(replace(situation, message=plain(own[0]), robots=(situation.robot,)))
        others = f"I do only my part; {listing(own[1])} must get this message too."
        return mine.model_copy(
            update={"message_response": f"{mine.message_response} {others}", "targets": (situation.robot,)}
        )
    words, targets = addressing.addressed(words, situation)
    situation = replace(situation, robot=targets[0] if targets else situation.robot)
    if not any(word.is_word for word in words):
        return _say(situation, "Yes? What can I do for you?", targets=targets)
    request = pending_request(words, situation)
    answer = social.reply(words) if request is None else None
    if answer is not None:
        return _say(situation, answer, targets=targets)
    if request is not None and request.declined:
        return _say(situation, "All right, I leave it.", targets=targets)
    if request is not None:
        words, targets = addressing.addressed(mended(tokens(request.message), situation), situation)
        situation = replace(situation, history=request.history)
    return _Reader(Scene.of(situation, request.hints if request else ()), targets=targets).read(words)


def _say(
    situation: Situation, text: str, *, commands: Sequence[SystemCommand] = (), targets: Sequence[str] = ()
) -> ChatAction:
    return ChatAction(
        message_response=text,
        system_cmd=tuple(commands),
        targets=tuple(targets) or ((situation.robot,) if situation.robot else ()),
    )


_REPORTS = frozenset(
    tuple(text.split())
    for text in (
        "tell me",
        "let me know",
        "report back",
        "report to me",
        "report",
        "inform me",
        "tell us",
        "tell me about it",
    )
)
"""What every look does anyway."""
_FOLLOW_ON = (("what", "about"), ("how", "about"), ("the", "same", "for"), ("same", "for"), ("same", "with"))


@dataclass
class _Reader(Answering):
    """Reads the clauses of one message in order."""

    def read(self, words: Phrase) -> ChatAction:
        self._mention_history()
        words = _as_visit(words)
        edit = read_replanning(words, self.scene)
        if edit is not None:
            self.commands.extend(edit.commands)
            return self._result(edit.reply, edit.queue)
        before: tuple[ActionCall, ...] = ()
        place = inserted(words, self.scene)
        if place is not None:
            words, at = place
            before = self.scene.situation.queue[at:]
            if any(step.flow is not None for step in before):
                before = ()
            count = len(self.scene.situation.queue)
            taken = range(count - 1, count - 1 - len(before), -1)
            self.commands.extend(SystemCommand(command="pop", arguments={"parameters": i}) for i in taken)
        parts = clauses(words, lambda phrase: opens_command(phrase, self.scene.catalogue.verbs))
        try:
            self._parts = parts
            self._leads_on = bool(words) and words[0].key in {"and", "now", "then", "next", "also"}
            for index, clause in enumerate(parts):
                if index >= len(self._parts):
                    break
                self._at = index
                self._clause(clause, alone=len(parts) == 1, index=index)
            self._complain()
        except UnclearError as unclear:
            self.commands = [c for c in self.commands if c.command != "pop"]
            return self._result(unclear.question, (), choices=unclear.choices)
        except UnableError as unable:
            self.commands = [c for c in self.commands if c.command != "pop"]
            return self._result(cannot(unable.what, self.scene), ())
        self.learn()
        return self._result(self._reply(), (*self.tasks.steps, *before))

    # -- clauses --

    def _clause(self, clause: Clause, *, alone: bool, index: int) -> None:
        start = len(self.tasks.steps)
        if clause.condition or clause.conditional:
            self._condition(clause)
            return
        clause = self._corrected(self._instead(clause))
        if self.tasks.steps and keys(strip_openers(clause.words)) in _REPORTS:
            return
        called = {part for name in self.scene.situation.robots for part in keys(tokens(name))} | {"robot"}
        if set(keys(strip_openers(clause.words))) <= called | {"dear", "my", "hi", "hello"}:
            return
        if not clause.words or lexicon().adverbs.match(keys(clause.words)) == (
            len(clause.words),
            plain(clause.words).lower(),
        ):
            return
        if self._order(clause, alone, index) or self._spoken(clause):
            return
        if self._named(clause):
            return
        command = self._command(clause)
        if command is not None:
            self._do(command)
        elif len(self.tasks.steps) == start and not self.state(clause):
            self._fallback(clause, alone=alone)

    def _named(self, clause: Clause) -> bool:
        """For "the chair A is on, go there": named by what is remembered, asked for by the next clause."""
        words = strip_openers(clause.words)
        if self._at == len(self._parts) - 1 or opens_command(words):
            return False
        item = self.scene.told_apart(words)
        if (
            item is None
            or not noun_phrase(words).core
            or read_command(words, self.scene.is_person) is not None
        ):
            return False
        self.scene.mention(tokens(item.description))
        self.scene.places.append(tokens(item.description))
        return True

    def _command(self, clause: Clause) -> Command | None:
        command = read_command(clause.words, self.scene.is_person, self.scene.catalogue.verbs)
        words = strip_openers(clause.words)
        if (
            keys(words)[:1] == ("you",)
            and keys(words)[2:3] == ("find",)
            and read_statement(words) is not None
        ):
            return None
        if command is None:
            command = (
                due(words, self.scene)
                or wish(words, self.scene)
                or need(words, self.scene)
                or missing(words, self.scene)
                or self._going(words)
                or self._elliptical(words)
            )
        if (
            command is not None
            and command.kind == "other"
            and read_statement(clause.words) is not None
            and not opens_command(clause.words)
        ):
            return None
        return command

    def _going(self, words: Phrase) -> Command | None:
        """For "to the desk": going needs no verb."""
        if keys(words)[:1] not in {("to",), ("over",), ("towards",), ("back",)} or len(words) < 2:
            return None
        return read_command((Word("go", "go"), *words), self.scene.is_person)

    def _elliptical(self, words: Phrase) -> Command | None:
        """For "Go to A, then B": a bare noun phrase does again what the clause before did."""
        words = self._follow_on(words)
        if (
            self.last is None
            or self.last.kind not in {"motion", "look", "search"}
            or not words
            or len(words) > 9
        ):
            return None
        negated = words[0].key == "not" and len(words) > 1
        words = words[1:] if negated else words
        found = lexicon().goals.match(keys(words))
        words = bare(words[found[0] :] if found and found[0] < len(words) else words)
        if not words or any(w.key in lexicon().be for w in words):
            return None
        if self.last.kind == "motion":
            return replace(
                self.last, place=words, clause=(Word("go", "go"), Word("to", "to"), *words), negated=negated
            )
        return replace(self.last, theme=words, place=(), clause=words, negated=negated)

    def _follow_on(self, words: Phrase) -> Phrase:
        """Also for "what about the desk?" and "and now the desk": as in the message before."""
        flat = keys(words)
        lead = next((lead for lead in _FOLLOW_ON if flat[: len(lead)] == lead), ())
        if self.last is None and (lead or self._leads_on):
            self.last = self._previous
        return words[len(lead) :]

    def _do(self, command: Command) -> None:
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
        self.last = command
        self._before_last = len(self.tasks.steps), len(self.tasks.will)
        if (
            command.kind == "transfer"
            and not command.recipient
            and not command.place
            and self._carried_on(command)
        ):
            self.tasks.collect(command)
            return
        own = self.scene.catalogue.for_verb(command.verb)
        if own is not None and any(kind == "number" for kind in own.inputs.values()) and not own.outputs:
            self.tasks.do(command)
            return
        for _ in range(self._times(command)):
            self.tasks.do(_without_times(command))
            if self._times(command) > 1:
                self.tasks.here = ""

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
        if not clause.condition:
            self._checked = ((), self._last_look())
        elif not self._same_condition(clause):
            protocol = keys(clause.condition)[:1] in {
                ("you",),
                ("i",),
                ("we",),
                ("anyone",),
                ("somebody",),
                ("someone",),
                ("anything",),
                ("something",),
            }
            if protocol:
                said = f"If {plain(clause.condition)}, {plain(clause.words)}"
                self.remember(
                    Fact(bare(clause.condition[-2:]), relation="protocol", state=clause.words, sentence=said)
                )
                return
            look = read_command(
                (Word("check", "check"), Word("whether", "whether"), *clause.condition), self.scene.is_person
            )
            if look is None:
                raise UnclearError(f"How can I tell whether {plain(clause.condition)}?")
            self.tasks.do(look)
            self._checked = (clause.condition, len(self.tasks.steps) - 1)
        start, told = len(self.tasks.steps), len(self.tasks.will)
        self._clause(replace(clause, condition=(), conditional=False), alone=False, index=1)
        flow = Flow(if_=FlowIf(step=self._checked[1], result=not clause.otherwise))
        self.tasks.steps[start:] = [
            step.model_copy(update={"flow": flow}) for step in self.tasks.steps[start:]
        ]
        word = "if not" if clause.otherwise else "if so"
        if len(self.tasks.will) > told:
            self.tasks.will[-1] = f"{word}, {self.tasks.will[-1]}"

    def _last_look(self) -> int:
        """The step that looked last, for "if not, ...".

        Raises:
            UnclearError: Nothing was looked at.
        """
        looks = {
            info.name
            for info in self.scene.catalogue.infos
            if self.scene.catalogue.roles(info) & {"look", "search"}
        }
        for index in range(len(self.tasks.steps) - 1, -1, -1):
            if self.tasks.steps[index].name in looks:
                return index
        raise UnclearError("What does that depend on? Please tell me what I should look at first.")

    def _same_condition(self, clause: Clause) -> bool:
        return bool(self._checked[0]) and keys(self._checked[0]) == keys(clause.condition)

    def _fallback(self, clause: Clause, *, alone: bool) -> None:
        words = strip_openers(clause.words)
        if not words or (words[0].key == "not" and self.replies):
            return
        if lexicon().insults & set(keys(words)):
            self.replies.append("I am sorry if I did something wrong. Tell me what I should do.")
            return
        noun = noun_phrase(words)
        found = self._grounded(noun.phrase) if noun.core and len(words) <= 6 else ""
        if found and self._at < len(self._parts) - 1:
            # "The desk by the door, go there": named first, asked for after.
            self.scene.mention(noun.phrase)
            self.scene.places.append(noun.phrase)
            return
        if found and {"please", "now", "immediately", "asap", "quickly", "next"} & set(keys(clause.words)):
            self._do(Command("motion", "go", place=noun.phrase, words=noun.phrase, clause=clause.words))
            return
        if found:
            raise UnclearError(f"What should I do with {the(found)}? I can go there or have a look at it.")
        if not alone and (told_around(words) or self._at < len(self._parts) - 1):
            # Stories around an order are no orders, but what they name may be meant by what follows.
            self.unread.append(words)
            for phrase in mentioned(words, self.scene):
                self.scene.mention(phrase)
                self.scene.places.append(phrase)
            return
        if not alone and (self.tasks.steps or self.commands or self.replies):
            self.replies.append(whole_sentence(f"I did not understand “{plain(words)[:80]}”"))
            return
        raise UnclearError(f"{social.not_understood(words)} {abilities(self.scene)}")

    def _grounded(self, phrase: Phrase) -> str:
        from parley.language.offline.grounding import ground_phrase

        found = ground_phrase(phrase, self.scene.objects)
        return plain(phrase) if found.outcome != "none" else ""

    # -- the result --

    def _mention_history(self) -> None:
        """What was spoken of before, for pronouns."""
        for turn in self.scene.situation.history[-6:]:
            if turn.role != "operator":
                continue
            for part in clauses(tokens(turn.content), opens_command):
                fact = read_statement(part.words)
                command = read_command(part.words, self.scene.is_person)
                if command is not None:
                    self._previous = None if command.negated else command
                    for phrase in (command.source, command.place, command.theme, command.recipient):
                        self.scene.mention(bare(phrase))
                    if command.place:
                        self.scene.places.append(command.place)
                elif fact is not None:
                    self.scene.mention(fact.subject)
                    if fact.place:
                        self.scene.places.append(fact.place)
                else:
                    self._mention_names(part.words)

    def _mention_names(self, words: Phrase) -> None:
        """What a question or a fragment was about."""
        about = words
        while len(about) > 1 and about[0].key in lexicon().question_starts | lexicon().be | {
            "about",
            "do",
            "you",
            "know",
        }:
            about = about[1:]
        known = find_fact(bare(about), self.scene.facts, locations=False)[0]
        if known is not None:
            self.scene.mention(bare(about))
            return
        for phrase in mentioned(words, self.scene):
            self.scene.mention(phrase)
            self.scene.places.append(phrase)


def _as_visit(words: Phrase) -> Phrase:
    """For "add (a stop at) the desk to the plan": a visit."""
    rest = strip_openers(words, requests=True)
    if keys(rest[:1]) not in {("add",), ("include",), ("insert",)} or len(rest) < 2:
        return words
    rest = rest[1:]
    flat = keys(rest)
    if flat[:2] in {("a", "stop"), ("a", "visit"), ("another", "stop"), ("a", "trip")} and len(flat) > 3:
        rest = rest[3:]
    plans = {"plan", "queue", "list", "route", "mission", "tour", "schedule"}
    for index in range(1, len(rest) - 2):
        if rest[index].key in {"to", "in", "into"} and rest[index + 2].key in plans:
            rest = (*rest[:index], *rest[index + 3 :])
            break
    return (Word("visit", "visit"), *rest) if rest else words


def _without_times(command: Command) -> Command:
    """Without "twice" and "three times" at the end of its parts."""

    def cut(phrase: Phrase) -> Phrase:
        flat = keys(phrase)
        if flat[-1:] == ("twice",):
            return phrase[:-1]
        return phrase[:-2] if flat[-1:] == ("times",) and len(flat) > 2 else phrase

    return replace(command, place=cut(command.place), theme=cut(command.theme))
