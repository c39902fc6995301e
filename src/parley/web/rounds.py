"""What robots were told to do and how it ended, and what the next shift has to know. Pure.

All of it is read off the log of who did what, and off what stands now; no language engine words it.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Any, Final

from pydantic import ValidationError

from parley.errors import FailureCode
from parley.gate.audit_text import told, who_of
from parley.messages.audit import AuditEntry
from parley.messages.incident import Incident
from parley.messages.principal import Principal
from parley.sentences import SpokenLanguage, in_language, sentence
from parley.web.models import RoundState, RoundView
from parley.web.state import WebState

__all__ = ["Graph", "rounds_of", "running_graphs", "told_lines", "waiting"]

Graph = tuple[str, str]
"""A robot and the name of what it does: never used twice."""
_OVER: Final = frozenset({"idle", "ended"})


def rounds_of(
    starts: Sequence[AuditEntry],
    others: Iterable[AuditEntry],
    running: frozenset[Graph],
    incidents: Sequence[Incident] = (),
    language: SpokenLanguage = "en",
) -> list[RoundView]:
    """Every beginning with its end, newest first; what was given up and put back is one round.

    Args:
        starts: Entries of the log with which robots began.
        others: Entries with which they came to an end, or went on with what was put back.
        running: What robots do just now; of what has no end and does not run, the end was never heard.
        incidents: What went wrong or needed a person, newest first.
        language: Of who it was.
    """
    rounds: dict[Graph, list[AuditEntry]] = {}
    whole: dict[Graph, Graph] = {}
    entries = {entry.number: entry for entry in (*starts, *others)}
    for _, entry in sorted(entries.items()):
        graph = _graph(entry)
        before = (entry.robot, str(entry.detail.get("continues") or graph[1]))
        whole.setdefault(graph, whole.get(before, before))
        rounds.setdefault(whole[graph], []).append(entry)
    found: dict[Graph, list[str]] = {}
    for one in reversed(incidents):
        graph = (one.robot, one.graph_name)
        if one.code is FailureCode.ATTENTION:
            found.setdefault(whole.get(graph, graph), []).append(in_language(one.message, language))
    shown = {entry.number for entry in starts}
    return [
        _round(entries, running, language).model_copy(
            update={"found": tuple(dict.fromkeys(found.get(graph, ())))}
        )
        for graph, entries in sorted(rounds.items(), key=lambda one: one[1][0].number, reverse=True)
        if entries[0].number in shown
    ]


def waiting(state: WebState, robot: str, language: SpokenLanguage = "en") -> tuple[str, ...]:
    """What stands still until a person does something, in sentences."""
    found = [
        sentence("{robot} waits for a yes: {what}", robot=proposal.robot, what=_steps(proposal.steps))
        for proposal in state.plans.proposals.values()
        if robot in ("", proposal.robot)
    ]
    asked = [entry for entry in state.chat.entries.values() if entry.question == "open"]
    found += [
        sentence("{robot} asks: {what}", robot=", ".join(entry.targets), what=entry.message)
        for entry in asked
        if not robot or robot in entry.targets
    ]
    asking = {name for entry in asked for name in entry.targets}
    stopped = [
        one.name for one in state.robots.views.values() if one.state == "stopped" or one.stop.state != "none"
    ]
    left = {
        plan.robot: (plan.state, _steps(steps))
        for plan in state.plans.views.values()
        if plan.state in ("paused", "held")
        if (steps := [step for step in plan.steps if step.state not in ("finished", "skipped", "stopped")])
    }
    found += [
        sentence("{robot} was held with steps left: {what}", robot=name, what=what)
        if held == "paused"
        else sentence("{robot} cannot go on alone with: {what}", robot=name, what=what)
        for name, (held, what) in left.items()
        if robot in ("", name) and name not in stopped and (held == "paused" or name not in asking)
    ]
    found += [
        sentence(
            "{robot} is stopped until somebody releases it, with steps left: {what}",
            robot=name,
            what=left[name][1],
        )
        if name in left
        else sentence("{robot} is stopped and stays so until somebody releases it.", robot=name)
        for name in stopped
        if robot in ("", name)
    ]
    return tuple(in_language(text, language) for text in found)


def running_graphs(state: WebState) -> frozenset[Graph]:
    """What robots do just now."""
    running = {key for key, plan in state.plans.views.items() if plan.state not in _OVER}
    return frozenset({*running, *state.plans.left_over})


def told_lines(entries: Iterable[AuditEntry], language: SpokenLanguage) -> tuple[tuple[int, str], ...]:
    """When and what, oldest first; what robots report of themselves is left out."""
    people = [entry for entry in entries if entry.by is None or entry.by.kind != "robot"]
    people.sort(key=lambda entry: entry.number)
    return tuple((entry.unix_ms, in_language(told(entry), language)) for entry in people)


def _round(entries: Sequence[AuditEntry], running: frozenset[Graph], language: SpokenLanguage) -> RoundView:
    """One round, of its first beginning and all that came of it."""
    start, last = entries[0], entries[-1]
    end = last if last.effect == "end" else None
    by = _principal(start.detail.get("asked_by")) or start.by
    approved = _principal(start.detail.get("approved_by"))
    return RoundView(
        number=start.number,
        robot=start.robot,
        words=str(last.detail.get("asked", start.detail.get("asked", ""))),
        by=in_language(who_of(by), language) if by else "",
        approved_by=in_language(who_of(approved), language) if approved else "",
        unix_ms=start.unix_ms,
        ended_unix_ms=end.unix_ms if end else 0,
        worked_ms=_worked_ms(entries) if end else None,
        state=_state(end, any(_graph(entry) in running for entry in entries)),
        steps=_all_steps(entries, language),
        left=_texts(last, "left", language),
        reason=in_language(end.reason, language) if end else "",
    )


def _worked_ms(entries: Iterable[AuditEntry]) -> int | None:
    found = [ms for entry in entries if isinstance(ms := entry.detail.get("worked_ms"), int)]
    return sum(found) if found else None  # logs of before do not hold it


def _all_steps(entries: Sequence[AuditEntry], language: SpokenLanguage) -> tuple[str, ...]:
    """What was done before something was put back, and then that."""
    steps: list[str] = []
    for at, entry in enumerate(entries):
        later = {_graph(other) for other in entries[at + 1 :]}
        if _graph(entry) in later:
            continue  # it tells more
        mine = [*reversed(_texts(entry, "labels", language))]
        # Of what was cut off it is not known what was done; what is done anew was not.
        left, cut = _texts(entry, "left", language), _texts(entries[-1], "labels", language)
        for out in (left if entry.effect == "end" else cut) if later else ():
            if out in mine:
                mine.remove(out)
        steps += reversed(mine)
    return tuple(steps)


def _state(end: AuditEntry | None, is_running: bool) -> RoundState:
    if end is None:
        return "running" if is_running else "unrecorded"
    if end.outcome == "failed":
        return "failed"
    if end.detail.get("state") == "STOPPED":
        return "ended"
    return "partly" if end.detail.get("left") else "done"


def _texts(entry: AuditEntry, name: str, language: SpokenLanguage) -> tuple[str, ...]:
    found = entry.detail.get(name)
    return tuple(in_language(str(text), language) for text in found) if isinstance(found, list) else ()


def _graph(entry: AuditEntry) -> Graph:
    return (entry.robot, str(entry.detail.get("graph", "")))


def _principal(value: Any) -> Principal | None:
    try:
        return Principal.model_validate(value)
    except ValidationError:
        return None


def _steps(steps: Iterable[Any]) -> str:
    return ", ".join(step.label for step in steps if not step.only_finds) or "–"
