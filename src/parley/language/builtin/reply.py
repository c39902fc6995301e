"""The reply, made from the decision and nothing else; and the message that carries both."""

from __future__ import annotations

import itertools
import re
from collections.abc import Iterator, Sequence

from parley.language.builtin import decision as decisions
from parley.language.builtin.decision import Answer, Ask, Control, Deed, Do, Edit, Forget, Remember
from parley.language.builtin.lexicon import Lexicon
from parley.language.builtin.saying import listed
from parley.language.builtin.structure import Part
from parley.language.builtin.wishes import Wish
from parley.language.dialogue.facts import kept_in_mind
from parley.messages.chat import ActionCall, ChatAction, LeftOpen, SystemCommand
from parley.messages.pvf import NATIVE_TYPES, native_type

__all__ = ["explained", "said", "to_chat"]


_CONTROLLED = {
    "stop": "I stop.", "pause": "I stop.", "start": "I go on.", "clear": "I drop all that I was told to do.",
    "skip": "I leave out this step.",
}  # fmt: skip


def to_chat(decision: decisions.Decision, lexicon: Lexicon) -> ChatAction:
    """The message that a decision is."""
    match decision:
        case Do(deeds, notes, told, robots):
            words = [note.text for note in notes] + [_remembered(fact) for fact in told]
            words.append(f"I will {_plan([deed for deed in deeds if not deed.hidden], lexicon)}.")
            return ChatAction(
                message_response=" ".join(words),
                queue=_calls(deeds, lexicon),
                system_cmd=_memories(told),
                targets=robots,
                sources=tuple(note.source for note in notes if note.source),
                left_open=LeftOpen(about=decision.about),
            )
        case Ask(question, choices, told=told):
            stop = (SystemCommand(command="stop"),) if decision.stops else ()
            facts = tuple(fact.text.removeprefix("that ") for fact in told)
            return ChatAction(
                message_response=" ".join([kept_in_mind(facts), question]).strip(),
                left_open=LeftOpen(where=decision.where, about=decision.about, told=facts),
                choices=choices,
                system_cmd=stop,
                alarm=decision.alarms,
                offer=_calls(decision.offer, lexicon),
                needs_yes=decision.unclear,
                called=decision.called,
                targets=decision.robots,
            )
        case Edit():
            return _changed(decision, lexicon)
        case Forget(names, texts):
            return ChatAction(
                message_response=f"I forget this: {'; '.join(texts)}.",
                system_cmd=tuple(
                    SystemCommand(command="remove_memory", arguments={"name": name}) for name in names
                ),
            )
        case Remember(told):
            return ChatAction(
                message_response=" ".join(_remembered(fact) for fact in told), system_cmd=_memories(told)
            )
        case Control(command, robots):
            return ChatAction(
                message_response=_CONTROLLED.get(command, "Yes."),
                system_cmd=(SystemCommand(command=command),),
                targets=robots,
            )
        case Answer(text, sources, waits):
            return ChatAction(message_response=text, sources=sources, left_open=LeftOpen(waits=waits))


def _calls(deeds: Sequence[Deed], lexicon: Lexicon) -> tuple[ActionCall, ...]:
    return tuple(_call(deed, deeds[:place], lexicon) for place, deed in enumerate(deeds))


def _changed(edit: Edit, lexicon: Lexicon) -> ChatAction:
    """A change of a plan: steps that are left out, the last first, and what comes in their place."""
    made = to_chat(edit.do, lexicon) if edit.do is not None else ChatAction()
    change = edit.change
    drops = () if edit.proposal or change.clears else change.drop
    clear = (SystemCommand(command="clear"),) if change.clears else ()
    return ChatAction(
        message_response=" ".join(text for text in (change.said, made.message_response) if text),
        queue=(*change.kept, *change.add, *made.queue, *change.rest),
        system_cmd=(
            *clear,
            *(SystemCommand(command="pop", arguments=_meant(place, edit.steps)) for place in drops),
            *made.system_cmd,
        ),
        sources=made.sources,
        replaces=edit.proposal,
    )


def _meant(place: int, steps: Sequence[str]) -> dict[str, object]:
    """Which step is meant: that one, whatever stands in its place later."""
    known = {"step": steps[place]} if place < len(steps) and steps[place] else {}
    return {"parameters": place, **known}


def said(deed: Deed, lexicon: Lexicon) -> str:
    """A deed in words: the frame's sentence with what its roles hold."""
    if deed.text:
        return deed.text
    frame = lexicon.frames.get(deed.frame)
    text = frame.say if frame else deed.frame.lower()

    def held(match: re.Match[str]) -> str:
        role = match[1]
        return deed.said.get(role, "")

    def kept(match: re.Match[str]) -> str:
        roles = re.findall(r"\{(\w)\}", match[1])
        return match[1] if all(deed.said.get(role) for role in roles) else ""

    return re.sub(r" +", " ", re.sub(r"\{(\w)\}", held, re.sub(r"\[([^\]]*)\]", kept, text))).strip()


def _plan(deeds: Sequence[Deed], lexicon: Lexicon) -> str:
    """Deeds in words, with what they depend on: "check whether ...; if so, go to ...; if not, wait"."""
    parts: list[str] = []
    for (check, holds), group in itertools.groupby(deeds, lambda deed: (id(deed.check), deed.holds)):
        told = listed([said(deed, lexicon) for deed in group], "and then")
        lead = f"if {'so' if holds else 'not'}, " if check != id(None) else "then " if parts else ""
        parts.append(f"{lead}{told}")
    return "; ".join(parts)


def _call(deed: Deed, before: Sequence[Deed], lexicon: Lexicon) -> ActionCall:
    inputs = {
        name: {"pvf_type": _type(deed.skill.action.inputs.get(name, ""), value), "pvf_value": value}
        for name, value in deed.arguments.items()
    }
    reason = f"find out where {deed.said['G']} is" if deed.hidden else said(deed, lexicon)
    body = {"input_parameters": inputs, "output_parameters": {}, "reason": reason, **_flow(deed, before)}
    return ActionCall.model_validate({deed.skill.action.name: body})


def _flow(deed: Deed, before: Sequence[Deed]) -> dict[str, object]:
    """On which earlier deed it depends, in the words of a plan."""
    if deed.check is None:
        return {}
    place = max(at for at, other in enumerate(before) if other is deed.check)
    return {"flow": {"if": {"step": place, "result": deed.holds}}}


def _type(declared: str, value: str | float | bool) -> str:
    """The declared type, or that of the value where the maker has words of his own ("int", "str")."""
    return declared if declared in NATIVE_TYPES else native_type(value)


def _remembered(fact: decisions.Told) -> str:
    return f"I will remember: {fact.text}." if fact.is_rule else f"I will remember that {fact.text}."


def _memories(told: Sequence[decisions.Told]) -> tuple[SystemCommand, ...]:
    return tuple(
        SystemCommand(
            command="add_memory", arguments={"name": fact.name, "data": fact.text, "info": fact.about}
        )
        for fact in told
    )


def explained(parts: Sequence[Part], decision: decisions.Decision) -> list[dict[str, str]]:
    """What was found in each clause of a message, and what was decided."""
    told = [*(pair for part in parts for pair in _of_part(part)), _of_decision(decision)]
    return [{"about": about, "text": text} for about, text in told]


def _of_part(part: Part) -> Iterator[tuple[str, str]]:
    yield "clause", f"“{part.text}” ({part.clause.link})"
    for wish in part.reading.wishes:
        yield "frame", _of_wish(wish)
    if part.reading.left_over:
        yield "left over", ", ".join(part.reading.left_over)
    if part.reading.unsteady:
        yield "doubtful", ", ".join(part.reading.unsteady)


def _of_wish(wish: Wish) -> str:
    roles = ", ".join(f"{filler.role} “{filler.text}”" for filler in wish.fillers)
    verb, no = (f"“{wish.verb}” is " if wish.verb else ""), ("not " if wish.negated else "")
    witness = {"agrees": "the lexicon agrees", "differs": "the lexicon differs"}.get(wish.witness, "")
    sure = f"{wish.act}, {wish.share:.2f} sure{f', {witness}' if witness else ''}"
    return f"{verb}{no}{wish.frame}{f' with {roles}' if roles else ''} ({sure})"


def _of_decision(decision: decisions.Decision) -> tuple[str, str]:
    kind = type(decision).__name__.lower()
    match decision:
        case Do(deeds):
            return kind, ", ".join(map(_of_deed, deeds))
        case Ask(question):
            offer = ", ".join(map(_of_deed, decision.offer))
            return kind, f"{question}{f' (offered: {offer})' if offer else ''}"
    return kind, ""


def _of_deed(deed: Deed) -> str:
    given = ", ".join(f"{name}: {value}" for name, value in deed.arguments.items())
    return f"{deed.skill.action.name}({given})"
