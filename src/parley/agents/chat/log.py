"""What one robot was asked, did and saw, taken from what crosses the topics. Pure; the time is handed in."""

from __future__ import annotations

from collections import OrderedDict
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from typing import Final, TypeVar

from parley.language.dialogue.indirect import due
from parley.language.dialogue.state import Asked, Deed, Dialogue, Ending, Order, Stop
from parley.messages.chat import LeftOpen
from parley.messages.status import ActionInfo, ActorStatus, GraphEvent, PlanProposal, PlanStep, PlanUpdate
from parley.messages.work import Work

__all__ = ["Log"]

_T = TypeVar("_T")
_Key = tuple[str, str]
"""Graph and node."""
_KEPT: Final = 200
_KEPT_ORDERS: Final = 20
_ASKED_TURNS: Final = 6
_ENDINGS: Final[dict[str, Ending]] = {
    "finished": "done", "failed": "failed", "stopped": "stopped", "skipped": "left out", "running": "running",
}  # fmt: skip


@dataclass(slots=True)
class _Facts:
    """What the engine tells of one node."""

    work: Work = field(default_factory=Work)
    left_text: str = ""
    over: bool = False
    is_false: bool = False
    seen: tuple[str, ...] = ()
    told: tuple[str, ...] = ()


@dataclass(slots=True)
class Log:
    """Of one robot; forgets the oldest."""

    _deeds: OrderedDict[tuple[str, str], Deed] = field(default_factory=OrderedDict)
    _orders: list[Order] = field(default_factory=list)
    _stopped: Stop | None = None
    _refused: str = ""
    _asked: tuple[Asked, int] | None = None
    """With the number of turns for which it may still be answered."""
    asked_in: str = ""
    """Id of the message whose reply asked that and awaits words; empty: none does."""
    lacks: bool = False
    """Whether what was said last lacks something, and that was asked for."""
    _waiting: list[str] = field(default_factory=list)
    _told: list[str] = field(default_factory=list)
    _plan: PlanUpdate | None = None
    _facts: OrderedDict[_Key, _Facts] = field(default_factory=OrderedDict)
    """What the engine tells of each node; the last is the newest that began."""

    def on_order(self, order: Order) -> None:
        """Somebody's words became steps."""
        self._orders.append(order)
        del self._orders[:-_KEPT_ORDERS]
        self._waiting = [words for words in self._waiting if not due(order.words, [words])]
        self._refused, self._asked = "", None

    def on_asked(self, asked: Asked, message: str = "") -> None:
        """An order has to be asked about first, in the reply to the message of that id."""
        alarm = asked.alarm or (self._asked is not None and self._asked[0].alarm)
        self._asked, self.asked_in = (replace(asked, alarm=alarm), _ASKED_TURNS), message

    @property
    def still_asks(self) -> str:
        """Id of the message whose reply asked what may be answered yet; empty if there is none."""
        return self.asked_in if self._asked is not None else ""

    @property
    def newest_order(self) -> Order | None:
        """What it was told last."""
        return self._orders[-1] if self._orders else None

    @property
    def has_just_asked(self) -> bool:
        """Whether nothing was said since an order was asked about."""
        return self._asked is not None and self._asked[1] == _ASKED_TURNS

    def on_given_up(self) -> None:
        """What was asked about is not wanted any more."""
        self._asked, self.lacks = None, False

    def on_left_open(self, words: str, left: LeftOpen) -> None:
        """A message was answered so that later ones may refer to it."""
        self._waiting = [*self._waiting, *([words] if left.waits else [])][-_KEPT_ORDERS:]
        self._told = [*self._told, *left.told][-_KEPT_ORDERS:]

    def on_turn(self) -> None:
        """Something was said; after a while nobody means what was asked long ago."""
        self.lacks = False
        if self._asked is not None:
            asked, left = self._asked
            self._asked = (asked, left - 1) if left > 1 else None

    def on_refused(self, why: str) -> None:
        """What was asked for last is not done."""
        self._refused = why

    def on_stop(self, words: str, by: str, unix_ms: int) -> None:
        """Somebody told the robot to stand still."""
        self._stopped = Stop(words, by, unix_ms)

    def on_plan(self, update: PlanUpdate, unix_ms: int, catalogue: Sequence[ActionInfo]) -> None:
        """The plan changed."""
        # What is dropped is told of no graph any more, and is not another deed for that.
        graph = update.graph_name or (self._plan.graph_name if self._plan is not None else "")
        self._plan = update
        effects = {info.name: info.effects for info in catalogue}
        for place, step in enumerate(update.steps):
            ending = _ENDINGS.get(step.state)
            if ending is None:
                continue
            key = (graph, step.node or f"{place} {step.label}")
            known = self._deeds.get(key)
            if known is None:
                order = self._orders[-1] if self._orders else None
                known = Deed(step.label, step.action, effects.get(step.action.name, ()), order)
            if known.ending == "running":
                _put(self._deeds, key, replace(known, ending=ending, unix_ms=unix_ms, label=step.label))

    def on_event(self, event: GraphEvent) -> None:
        """A step began, came further or ended."""
        key = (event.graph_name, event.node)
        if event.kind == "node" and event.state == "RUNNING" and key not in self._facts:
            _put(self._facts, key, _Facts())
        facts = self._facts.get(key)
        if facts is None:
            return
        if event.state == "RUNNING" and facts.over:  # it is done once more
            facts.over, facts.left_text = False, ""
        facts.work.on_event(event)
        if event.kind == "progress":
            facts.left_text = event.progress_text.rstrip(".")
        if event.result:
            found = event.outputs.get("seen")
            facts.seen = tuple(map(str, found.value)) if found is not None and found.has_data else ()
            facts.over, facts.is_false = True, event.result == "on_false"

    def on_said(self, text: str) -> None:
        """The step that runs said something."""
        key = next(reversed(self._facts), None)
        if key is not None and not self._facts[key].over:
            self._facts[key].told += (text,)

    def state(self, status: ActorStatus | None, proposal: PlanProposal | None, now_unix_ms: int) -> Dialogue:
        """What is known at this moment."""
        plan = self._plan
        steps: tuple[PlanStep, ...] = plan.steps if plan is not None else ()
        at_work = [
            self._facts.get((plan.graph_name, step.node))
            for step in reversed(steps)
            if plan is not None and step.state in ("running", "paused")
        ]
        newest = next((one for one in at_work if one is not None and not one.over), _Facts(over=True))
        return Dialogue(
            plan=plan.state if plan is not None else "idle",
            steps=steps,
            proposal=proposal,
            deeds=tuple(self._deed(key) for key in self._deeds),
            orders=tuple(self._orders),
            asked=self._asked[0] if self._asked is not None else None,
            waiting=tuple(self._waiting),
            told=tuple(self._told),
            stopped=self._stopped,
            refused=self._refused,
            left_s=None if newest.over else newest.work.left_s(now_unix_ms),
            left_text="" if newest.over else newest.left_text,
            battery=status.battery if status is not None else None,
            latched=status is not None and status.state == "stopped",
            now_unix_ms=now_unix_ms,
        )

    def _deed(self, key: _Key) -> Deed:
        deed, facts = self._deeds[key], self._facts.get(key)
        if facts is None:
            return deed
        ending: Ending = "no" if facts.is_false and deed.ending == "done" else deed.ending
        return replace(deed, ending=ending, seen=facts.seen, told=facts.told)


def _put(kept: OrderedDict[_Key, _T], key: _Key, value: _T) -> None:
    kept[key] = value
    while len(kept) > _KEPT:
        kept.popitem(last=False)
