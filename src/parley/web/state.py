"""Everything the page sees, computed from messages alone: no transport, no loop, no clock of its own."""

from __future__ import annotations

from collections.abc import Callable, Iterable

from parley.gate.table import Effect
from parley.latest import Latest
from parley.messages.audit import AuditEvent
from parley.messages.incident import Incident
from parley.messages.map import MapView
from parley.messages.memory import MemoryEvent
from parley.messages.status import GraphEvent, PlanProposal, PlanUpdate, Rejection
from parley.messages.team import MissionInfo, MissionList
from parley.web.changes import ChangeLog
from parley.web.chat_state import ChatBook, KeepPictures
from parley.web.feed_state import FeedBook
from parley.web.models import (
    AbilityView,
    ChatChange,
    ChatEntry,
    Favourite,
    FavouritesChange,
    IncidentChange,
    InfoChange,
    MemoryChange,
    MissionsChange,
    RejectionChange,
    RulesChange,
    ServerInfo,
    Snapshot,
)
from parley.web.plan_state import PlanBook
from parley.web.robot_state import RobotBook

__all__ = ["SNAPSHOT_ENTRIES", "WebState"]

SNAPSHOT_ENTRIES = 100
"""How much of the conversation a snapshot holds, besides open questions."""
INCIDENTS_KEPT = 200

_STOP_CODES = frozenset({"stop_failed", "reset_failed", "still_moving", "stopped_since"})


class WebState:
    """The books of robots, chat, plans, feeds and incidents, and the one log of what changes in them.

    Args:
        run: Names the log, see `Snapshot.run`.
        keep: Gets each chat entry that is new or has changed and hands it to `show` when it is durable;
            drafts are shown at once.
        new_id: Makes keys.
        entries: The end of the conversation so far, oldest first.
        has_older: Whether the conversation began before those.
        keep_pictures: See `ChatBook`.
    """

    def __init__(
        self,
        run: str,
        *,
        keep: Callable[[ChatEntry], None],
        new_id: Callable[[], str],
        entries: Iterable[ChatEntry] = (),
        has_older: bool = False,
        keep_pictures: KeepPictures = lambda key, images: (),
    ) -> None:
        self.log = ChangeLog(run)
        self._keep, self._has_older = keep, has_older
        self.robots = RobotBook(self.log.add)
        self.chat = ChatBook(self._on_entry, new_id, entries, keep_pictures)
        self.plans = PlanBook(self.log.add, self.ability_of)
        self.feeds = FeedBook(self.log.add)
        self.incidents: Latest[str, Incident] = Latest(INCIDENTS_KEPT)
        self.views: dict[str, MapView] = {}
        self.favourites: tuple[Favourite, ...] = ()
        self.missions: tuple[MissionInfo, ...] = ()

    def show(self, entry: ChatEntry) -> None:
        """Tell everybody of a chat entry."""
        self.log.add(ChatChange(seq=0, entry=entry))

    def on_plan(self, message: PlanUpdate | PlanProposal) -> None:
        """The planner speaks."""
        if isinstance(message, PlanProposal):
            self.plans.on_proposal(message)
            return
        waited = self._waits(message.target)
        self.plans.on_update(message)
        self.robots.on_plan(message)
        if waited and not self._waits(message.target):
            self.chat.on_decided(message.target)

    def _waits(self, robot: str) -> bool:
        """Whether something that a robot proposed waits for a yes."""
        return any(proposal.robot == robot for proposal in self.plans.proposals.values())

    def on_event(self, event: GraphEvent) -> None:
        """An engine speaks."""
        self.plans.on_event(event)

    def on_incident(self, incident: Incident) -> None:
        """A failure happened, or its record changed."""
        self.incidents[incident.id] = incident
        self.log.add(IncidentChange(seq=0, incident=incident))

    def set_favourites(self, favourites: Iterable[Favourite]) -> None:
        """They are these now."""
        self.favourites = tuple(favourites)
        self.log.add(FavouritesChange(seq=0, favourites=self.favourites))

    def on_info(self, info: ServerInfo) -> None:
        """Something else understands people now."""
        self.log.add(InfoChange(seq=0, info=info))

    def on_missions(self, told: MissionList) -> None:
        """What has become of orders to several robots."""
        self.missions = told.missions
        self.log.add(MissionsChange(seq=0, missions=self._shown_missions))

    @property
    def _shown_missions(self) -> tuple[MissionInfo, ...]:
        """Without what only programs read, as all of it goes to every page at each change."""
        return tuple(one.model_copy(update={"parts": tuple(
            part.model_copy(update={"steps": ()}) for part in one.parts
        )}) for one in self.missions)  # fmt: skip

    def on_memory(self, event: MemoryEvent) -> None:
        """Something was remembered or forgotten."""
        self.log.add(MemoryChange(seq=0, event=event.kind, name=event.name, message=event.message))

    def on_audit(self, event: AuditEvent) -> None:
        """Somebody did something; of rules nothing else tells."""
        if event.effect == Effect.RULE and event.outcome == "done":
            self.log.add(RulesChange(seq=0))

    def on_view(self, view: MapView) -> None:
        """A robot moved."""
        self.views[view.actor] = view

    def on_rejection(self, rejection: Rejection) -> None:
        """Something was refused; people hear it in plain words, unless a robot says it in the chat itself."""
        self.plans.on_rejection(rejection)
        text = self._plain(rejection)
        if text:
            self.log.add(RejectionChange(seq=0, robot=rejection.target or rejection.source, message=text))

    def remove_robot(self, name: str) -> None:
        """Take a robot off every list."""
        self.plans.forget(name)
        self.chat.on_decided(name)
        self.views.pop(name, None)
        self.robots.remove(name)

    def ability_of(self, robot: str, action: str) -> AbilityView | None:
        """What the robot's catalogue says of an action."""
        view = self.robots.views.get(robot)
        return next((item for item in view.catalogue if item.name == action), None) if view else None

    def snapshot(self, info: ServerInfo) -> Snapshot:
        """Everything as it stands."""
        chat = self.chat.newest(SNAPSHOT_ENTRIES)
        return Snapshot(
            run=self.log.run,
            seq=self.log.seq,
            info=info,
            robots=tuple(self.robots.views.values()),
            chat=tuple(chat),
            chat_complete=not self._has_older and len(self.chat.entries) <= len(chat),
            plans=tuple(self.plans.views.values()),
            proposals=tuple(self.plans.proposals.values()),
            feeds=tuple(self.feeds.infos.values()),
            incidents=tuple(self.incidents.values()),
            views=tuple(self.views.values()),
            favourites=self.favourites,
            missions=self._shown_missions,
        )

    def _on_entry(self, entry: ChatEntry) -> None:
        if entry.draft:
            self.show(entry)
        else:
            self._keep(entry)

    def _plain(self, rejection: Rejection) -> str:
        robot = rejection.target or rejection.source
        codes = {problem.code for problem in rejection.problems}
        if "stop_latched" in codes:
            return f"{robot} does not move until its emergency stop is released."
        stop = next((problem for problem in rejection.problems if problem.code in _STOP_CODES), None)
        if stop is not None:
            remedy = f" Please {stop.remedy}." if stop.remedy else ""
            return f"{stop.message.rstrip('.')}.{remedy}"
        if rejection.what.endswith("plan_decision"):
            return ""  # whoever pressed is told why, and so is the chat
        plan = self.plans.views.get((rejection.source, rejection.graph_name))
        is_told = rejection.source not in self.robots.views or (plan is not None and plan.kind == "plan")
        if is_told and "invalid_message" not in codes:
            return ""
        return f"{robot} could not take that, so nothing was changed."
