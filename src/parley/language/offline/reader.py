"""Reads one message: its clauses in order, each understood against what came before."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

from parley.language.offline.dialogue.asked import asked
from parley.language.offline.dialogue.plain_question import plain_question
from parley.language.offline.facts.declared import is_statement
from parley.language.offline.facts.facts import read_statement, strip_openers
from parley.language.offline.facts.stories import mentioned, told_around
from parley.language.offline.plan_changes.keeping import restarts
from parley.language.offline.plan_changes.rearranging import rearranged, without_going_on
from parley.language.offline.plan_changes.repeating import counted_times, repetition, without_recurrence
from parley.language.offline.plan_changes.rereading import Rereading
from parley.language.offline.scene.marks import marks_of
from parley.language.offline.scene.reported import asked_by_need, asked_by_report
from parley.language.offline.scene.scene import UnclearError
from parley.language.offline.scene.subsets import with_exception_behind
from parley.language.offline.sentences.clauses import Clause, clauses, opens_command
from parley.language.offline.sentences.constructions import recast
from parley.language.offline.sentences.doing_stops import as_stops
from parley.language.offline.sentences.itineraries import warns
from parley.language.offline.sentences.remarks import (
    as_visit,
    hurries,
    is_deed,
    is_span,
    is_strange_order,
    says_something,
    says_where_i_am,
    without_frame,
)
from parley.language.offline.sentences.rewording import reworded
from parley.language.offline.sentences.spoken import Names, spoken
from parley.language.offline.tasks.abilities import abilities, cannot
from parley.language.offline.tasks.catalogue import call
from parley.language.offline.tasks.commands import Command, read_command
from parley.language.offline.tasks.helping import for_each, is_drastic
from parley.language.offline.tasks.matching import Match
from parley.language.offline.tasks.tasks import UnableError
from parley.language.offline.words import social
from parley.language.offline.words.concepts import concepts, likeness
from parley.language.offline.words.durations import duration_s
from parley.language.offline.words.lexicon import lexicon
from parley.language.offline.words.naming import name_words
from parley.language.offline.words.nouns import noun_phrase
from parley.language.offline.words.saying import listing, the, whole_sentence
from parley.language.offline.words.text import Phrase, Word, keys, plain, split_name, tokens
from parley.messages.chat import ChatAction, SystemCommand
from parley.messages.status import ActionInfo

__all__ = ["Reader"]

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

_NOTHING_MORE = frozenset(
    tuple(text.split())
    for text in (
        "nothing else",
        "nothing more",
        "that is all",
        "that is it",
        "only that",
        "just that",
        "no more",
    )
)


_ASKING = frozenset({"has", "does", "did", "may", "should", "must", "will", "can", "could"})
_MOST_TIMES = 20
_LONGEST_SUBJECT = 4
_LEADING_ON = frozenset({"and", "now", "then", "next", "also", "no", "nope"})


@dataclass
class Reader(Rereading):
    """Reads the clauses of one message in order."""

    def read(self, words: Phrase) -> ChatAction:
        """Understand a whole message."""
        self._mention_history()
        self._mention_answer()
        self.scene.heard = len(self.scene.things)
        self.keep_lists()
        words = self.with_owners(words)
        if self.replies and not any(word.is_word for word in words):
            return self._result(self._reply(), ())
        for phrase in self.about:
            self.scene.mention(phrase)
            if self._on_map(phrase):
                self.scene.places.append(phrase)
        words = without_going_on(words) if self.scene.situation.queue else words
        asks = keys(strip_openers(words))[:1] in {(start,) for start in lexicon().question_starts}
        answer = self._about_plan(words, asks=asks)
        if answer is not None:
            return answer
        plainer = as_visit(spoken(words, self.scene), self.scene.catalogue.verbs)
        words = reworded(plainer, self._on_map, timed=self.scene.catalogue.times_itself)
        order = recast(words, self.scene) if self.scene.situation.queue else None
        words = order[0] if order is not None else words
        if restarts(words) and self._restart():
            return self._result(self._reply(), self.tasks.steps)
        words = self._grouped(words) if self.scene.situation.queue else words
        words, often = without_recurrence(words)
        words, times = counted_times(words) if often else (words, 1)
        return self._carried_out(words, often, times)

    def _about_plan(self, words: Phrase, *, asks: bool) -> ChatAction | None:
        """The answer to what is about pending steps: a question, or that they are to be done another way."""
        queue = self.scene.situation.queue
        asking = plain_question(words, marked=keys(words[-1:]) == ("?",))
        asks = asks or keys(asking)[:1] in {(start,) for start in lexicon().question_starts}
        about_plan = asked(asking, keys(asking), self.scene) if asks and queue else None
        if about_plan is not None and not about_plan.look:
            return self._result(about_plan.text, ())
        once_more = self._changed_again(words)
        if once_more is not None:
            return once_more
        change = rearranged(words, self.scene)
        return self._rearranged(change) if change is not None else None

    def help_with(self, match: Match, words: Phrase, *, agreed: bool) -> ChatAction:
        """What helps with something that is only told.

        Args:
            match: The action that helps, and what is said for its inputs.
            words: What is told.
            agreed: Whether it was asked about, and agreed to; what is drastic is done only then.
        """
        before = len(self.tasks.will)
        try:
            for one in for_each(match, self.scene):
                self.tasks.use_own(one, words)
        except UnclearError as unclear:
            self.trouble = unclear
            return self._result(unclear.question, (), choices=unclear.choices)
        except UnableError as unable:
            self.trouble = unable
            return self._result(cannot(unable.what, self.scene), ())
        does = match.info.description.rstrip(".") or " ".join(name_words(match.info.name))
        about = listing([plain(phrase) for phrase in match.filled.phrases.values()])
        deed = f"{does[:1].lower()}{does[1:]}{f' ({about})' if about else ''}"
        if is_drastic(match) and not agreed:
            return self._result(f"Shall I {deed}?", ())
        self.tasks.will[before:] = [deed]
        return self._result(self._reply(), self.tasks.steps)

    def _carried_out(self, words: Phrase, often: str, times: int) -> ChatAction:
        """Clause by clause."""
        words = with_exception_behind(words)
        parts = clauses(words, lambda phrase: opens_command(phrase, self.scene.catalogue.verbs))
        self._hurried = any(hurries(part) for part in parts[1:])
        parts = [part for i, part in enumerate(parts) if not i or not hurries(part)]
        is_stop = Names(self.scene).is_stop
        parts = [replace(part, words=as_stops(part.words, is_stop)) for part in parts]
        # Where the operator is counts from the start, wherever it is said ("get it, I am at the door").
        parts = sorted(parts, key=lambda part: not says_where_i_am(part))
        self._leads_on = bool(words) and words[0].key in _LEADING_ON
        try:
            self._in_turn(self.arranged(parts))
            self._skip_nothing()
            self._complain()
            self._recurs(often, times)
        except UnclearError as unclear:
            self.trouble = unclear
            self.scene.trace.note("question", unclear.question)
            self.commands = [c for c in self.commands if c.command != "pop"]
            return self._result(unclear.question, (), choices=unclear.choices)
        except UnableError as unable:
            self.trouble = unable
            self.scene.trace.note("action", f"nothing in the catalogue can {unable.what}")
            self.commands = [c for c in self.commands if c.command != "pop"]
            return self._result(cannot(unable.what, self.scene), ())
        self.learn()
        return self._result(self._reply(), self.tasks.steps)

    def _in_turn(self, parts: Sequence[Clause]) -> None:
        """Read clause after clause; what is read may change those that follow."""
        self._parts = parts
        for clause in parts:
            self.scene.trace.note("clause", clause.said())
        for index, clause in enumerate(parts):
            if index >= len(self._parts):
                break
            self._at = index
            start = len(self.tasks.steps)
            self.tasks.beside = clause.beside and start > 0
            known = len(self.scene.things)
            self._clause_or_story(clause, index, parts)
            self._side_by_side(start)
            self._seen_already(start)
            if len(self.scene.things) == known and len(self.tasks.steps) == start and index + 1 < len(parts):
                self._mention_subject(clause.words)

    def _mention_subject(self, words: Phrase) -> None:
        """Keep for "it" what something is told of ("the roses look dry, measure how bad it is")."""
        if not words or words[0].key not in lexicon().determiners:
            return
        for size in range(min(_LONGEST_SUBJECT, len(words) - 1), 1, -1):
            found = self.scene.ground(words[:size])
            if found.outcome == "match":
                self.scene.mention(tokens(found.candidates[0].description))
                return

    def _skip_nothing(self) -> None:
        """For "the desk was done, leave it" among orders: there is no step that could be left out."""
        if self.tasks.steps and not self.scene.situation.queue:
            self.commands = [c for c in self.commands if c.command != "skip"]

    def _clause_or_story(self, clause: Clause, index: int, parts: Sequence[Clause]) -> None:
        """Read one clause; what makes no sense among orders and names nothing is only told around them."""
        start = len(self.tasks.steps)
        try:
            self._clause(clause, alone=len(parts) == 1, index=index)
        except (UnclearError, UnableError) as error:
            verbs = self.scene.catalogue.verbs
            others = any(opens_command(part.words, verbs) for part in parts if part is not clause)
            named = (
                (isinstance(error, UnclearError) and mentioned(clause.words, self.scene))
                or clause.condition
                or clause.conditional
            )
            if not others or named or opens_command(clause.words, verbs):
                raise
            del self.tasks.steps[start:]
            self.unread.append(clause.words)
            for phrase in mentioned(clause.words, self.scene):
                self.scene.mention(phrase)
                self.scene.places.append(phrase)

    def _on_map(self, words: Phrase) -> bool:
        return self.scene.ground(words).outcome != "none"

    def _clause(self, clause: Clause, *, alone: bool, index: int) -> None:
        start = len(self.tasks.steps)
        if clause.condition or clause.conditional:
            self._condition(clause)
            return
        clause = self._corrected(clause)
        clause = replace(clause, words=without_frame(clause.words))
        if warns(clause.words) and not opens_command(clause.words, self.scene.catalogue.verbs):
            self.told_only = True
            return
        if keys(strip_openers(clause.words)) in _NOTHING_MORE and (self.tasks.steps or self.replies):
            return
        if self.tasks.meet(clause.words):
            self.scene.trace.note("frame", f"with people: {clause.said()}")
            return
        others = [part for part in self._parts if part.words != clause.words]
        order = asked_by_need(clause, others, self.scene) or recast(clause.words, self.scene)
        if order is None:
            order = asked_by_report(clause, others, self.scene)
            self.reported |= order is not None
        if order is not None:
            self.scene.trace.note("recast", f"“{plain(order[0])}”, after the pattern: {order[1]}")
            clause = replace(clause, words=order[0], is_question=False)
        tells = order is not None and keys(order[0][:1]) == ("tell",) and self.tasks.meet(clause.words)
        if tells or self._again(clause) or self._delayed(clause) or self._says_nothing(clause, alone=alone):
            return
        if self._reading(clause) or self._order(clause, alone, index) or self._spoken(clause):
            return
        if self._named(clause):
            return
        command = self._command(clause)
        if command is not None:
            self._do(command)
        elif len(self.tasks.steps) == start and not self.state(clause):
            self._fallback(clause, alone=alone)

    def _says_nothing(self, clause: Clause, *, alone: bool) -> bool:
        """Whether it only calls the robot, is courteous, or asks for a report that is made anyway."""
        if self.tasks.steps and keys(strip_openers(clause.words)) in _REPORTS:
            return True
        called = {part for name in self.scene.situation.robots for part in keys(tokens(name))} | {"robot"}
        if set(keys(strip_openers(clause.words))) <= called | {"dear", "my", "hi", "hello"}:
            return True
        courtesy = lexicon().polite.match(keys(clause.words)) if clause.words else None
        if courtesy is not None and courtesy[0] == len(clause.words) and not alone:
            return True
        manner = lexicon().adverbs.match(keys(clause.words))
        return not clause.words or manner == (len(clause.words), plain(clause.words).lower())

    def _again(self, clause: Clause) -> bool:
        """For "do that again", "repeat the last step"."""
        found = None if clause.is_question else repetition(clause.words, self.scene)
        if found is None:
            return False
        if found.steps and not self.tasks.steps:
            self.tasks.steps += [step.model_copy(update={"flow": None}) for step in found.steps]
            self.tasks.will.append("do that once more")
        elif self.tasks.steps:
            self.tasks.steps += [step for step in self.tasks.steps if step.flow is None]
            self.tasks.will.append("do all of that once more")
        else:
            self._last_order_again()
        return True

    def _recurs(self, often: str, times: int) -> None:
        """What is asked for again and again: so often, with waiting in between, if that can be, else once."""
        steps, span_s = list(self.tasks.steps) if often else [], duration_s(tokens(often))
        waiter = self.scene.catalogue.with_role("wait")
        numbers = [n for n, kind in waiter.inputs.items() if kind == "number"] if waiter is not None else []
        counted = 1 < times <= _MOST_TIMES and span_s is not None and not any(step.flow for step in steps)
        if steps and counted and waiter is not None and len(numbers) == 1:
            pause = call(waiter, {numbers[0]: span_s}, f"wait until the next time, {often}")
            self.tasks.steps += [step for _ in range(times - 1) for step in (pause, *steps)]
            self.tasks.will.append(f"do that {times} times, {often}")
        elif steps:
            text = f"I cannot do that {often} by myself, so I do it once now; please tell me each time."
            self.tasks.notes.append(text)

    def _restart(self) -> bool:
        """Begin again: what was asked for last, or else what is still pending; False if there is neither."""
        situation = self.scene.situation
        asked = any(turn.role == "operator" for turn in situation.history)
        if not asked and not situation.queue:
            return False
        if situation.queue:
            self.commands.append(SystemCommand(command="clear"))
        self.replies.append("I start over.")
        again = self.last_order()
        if again:
            self.tasks.steps += again
            return True
        try:
            self._last_order_again()
        except UnclearError:
            self.tasks.steps += situation.queue
        return True

    def _reading(self, clause: Clause) -> bool:
        """For "what is your battery level?", where an action without inputs tells it."""
        if self._measured(clause):
            return True
        info = self.scene.catalogue.reading(keys(clause.words))
        if info is None or len(clause.words) > 9 or read_statement(clause.words) is not None:
            return False
        self.tasks.do(
            Command(
                "other",
                split_name(info.name)[0],
                words=clause.words,
                clause=tokens(f"{split_name(info.name)[0]} {the(' '.join(split_name(info.name)[1:]))}"),
            )
        )
        return True

    def _measured(self, clause: Clause) -> bool:
        """For "how warm is it in the hall?", where an action measures just that."""
        words = strip_openers(clause.words)
        asks = keys(words[:1])
        if not asks or asks[0] not in lexicon().question_starts | lexicon().be | {"tell", "has", "have"}:
            return False
        match = self.tasks.own_match(words, weak=True)
        if match is None or not (match.info.outputs or self._tells(match.info)):
            return False
        self.tasks.use_own(match, words)
        return True

    def _tells(self, info: ActionInfo) -> bool:
        """Whether an action finds something out, by its name."""
        finds = concepts(("measure",))[0]
        counts = "count" in self.scene.catalogue.roles(info)
        return counts or any(likeness(finds, verb) > 0 for verb in concepts(name_words(info.name)[:1]))

    def _is_place(self, words: Phrase) -> bool:
        """Whether words name one object of the map and say nothing else."""
        return 0 < len(words) <= 6 and self.scene.ground(strip_openers(words)).outcome == "match"

    def _delayed(self, clause: Clause) -> bool:
        """For "in five minutes(, go to the desk)": waiting comes first."""
        words = strip_openers(clause.words)
        if clause.is_question:
            return False
        at = next(
            (i for i in range(2, len(words) - 1) if words[i].key == "in" and is_span(words[i + 1 :])), 0
        )
        if at and opens_command(words) and not says_something(words):
            if self._takes_time(words):
                return False
            words = (*words[at:], *words[:at])
        if keys(words[:1]) not in {("in",), ("after",)}:
            return False
        end = next((i + 1 for i, w in enumerate(words) if duration_s(words[: i + 1]) is not None), 0)
        end += 2 if keys(words[end : end + 2]) in {("from", "now"), ("or", "so")} else 0
        if not end or end > 6:
            return False
        span = words[1:end]
        wait = read_command((Word("wait", "wait"), Word("for", "for"), *span), self.scene.is_person)
        later = self._at < len(self._parts) - 1 or end < len(words)
        if wait is None or not later:
            return False
        self._do(wait)
        if end < len(words):
            self._clause(replace(clause, words=words[end:]), alone=False, index=1)
        return True

    def _takes_time(self, words: Phrase) -> bool:
        """Whether an action of its own kind takes when it is due ("remind A in ten minutes")."""
        match = self.tasks.own_match(words, weak=True)
        return (
            match is not None and match.complete and any("timer" in names for names in match.filled.measured)
        )

    def _last_order_again(self) -> None:
        """What the operator's last message that asked for something asked for.

        Raises:
            UnclearError: No message asked for anything.
        """
        for turn in reversed(self.scene.situation.history):
            words = tokens(turn.content)
            listed = clauses(words, lambda phrase: opens_command(phrase, self.scene.catalogue.verbs))
            if turn.role != "operator" or not any(
                read_command(c.words, self.scene.is_person, self.scene.catalogue.verbs) for c in listed
            ):
                continue
            if any(repetition(c.words, self.scene) for c in listed):
                continue
            for part in listed:
                self._clause(part, alone=False, index=1)
            return
        raise UnclearError("What should I do again? Please name it.")

    def _only_named(self, clause: Clause, phrase: Phrase, found: str) -> None:
        """An object is named and nothing said of it: a place to go, or what the next clause is about.

        Raises:
            UnclearError: Nothing tells what to do with it.
        """
        sets_out = {"start", "begin", "first", "finish", "end"} & set(keys(clause.words[:2]))
        hurried = self._hurried or {"please", "now", "immediately", "asap", "quickly", "next"} & set(
            keys(clause.words)
        )
        more = self._at < len(self._parts) - 1
        # "The desk, then the door": places and nothing else are a way to go.
        grouped = any(marks_of(word) for word in phrase)
        a_way = len(self._parts) > 1 and all(self._is_place(part.words) for part in self._parts)
        if sets_out or grouped or a_way or (hurried and not more):
            self._do(Command("motion", "go", place=phrase, words=phrase, clause=clause.words))
        elif more:
            # "The desk by the door, go there": named first, asked for after.
            self.scene.mention(phrase)
            self.scene.places.append(phrase)
        else:
            raise UnclearError(f"What should I do with {the(found)}? I can go there or have a look at it.")

    def _fallback(self, clause: Clause, *, alone: bool) -> None:
        words = strip_openers(clause.words)
        if not words or (words[0].key == "not" and self.replies):
            return
        if lexicon().insults & set(keys(words)):
            self.replies.append("I am sorry if I did something wrong. Tell me what I should do.")
            return
        noun = noun_phrase(words)
        short = len(words) <= (12 if noun.anchors else 6)
        found = self._grounded(noun.phrase) if noun.core and short else ""
        if found:
            self._only_named(clause, noun.phrase, found)
            return
        if not alone and (told_around(words) or self._at < len(self._parts) - 1):
            # Stories around an order are no orders, but what they name may be meant by what follows.
            self.unread.append(words)
            for phrase in mentioned(words, self.scene):
                self.scene.mention(phrase)
                self.scene.places.append(phrase)
            for known in self.scene.facts:
                if f" {' '.join(keys(known.fact.subject))} " in f" {' '.join(keys(words))} ":
                    self.scene.mention(known.fact.subject)
            return
        if not alone and (self.tasks.steps or self.commands or self.replies):
            self.replies.append(whole_sentence(f"I did not understand “{plain(words)[:80]}”"))
            return
        wanted = strip_openers(words, requests=True)
        if (len(wanted) < len(words) and is_deed(wanted)) or (alone and is_strange_order(wanted)):
            raise UnableError(plain(wanted))
        if clause.is_question and alone and words[0].key in lexicon().be | _ASKING:
            self.replies.append("I do not know that. Tell me, and I will remember it.")
            return
        if alone and not clause.is_question and is_statement(clause.words):
            self.told_only = True
            return
        raise UnclearError(f"{social.not_understood(words)} {abilities(self.scene)}", lost=True)
