"""Programs, viewers and engines that write to the topics as if they were operators."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Final

from parley.messages import topics
from parley.messages.chat import Aside, ChatAction, ChatInput
from parley.messages.principal import Principal, person
from parley.messages.ros import String
from parley.messages.status import PlanDecision, PlanProposal, StopCommand
from parley.messages.topics import Topic
from parley.messages.wire import to_string
from tests.attacks.cases import CLEAR, SKIP, START, When, Wire, a, add, drive, forget, go, valve, wave
from tests.attacks.hostile_replies import fix
from tests.attacks.house import ADA, BO, KIM, VIEWER, House

ENGINE: Final = Principal(kind="engine", name="hostile model")
RULE: Final = Principal(kind="rule", name="Kim")
SCHEDULE: Final = Principal(kind="schedule", name="nightly")
KEYED: Final = Principal(kind="program", name="clock", key="clock")
ROBOT: Final = Principal(kind="robot", name=BO)
NOBODY: Final = None
STRANGERS: Final[dict[str, Principal | None]] = {
    "nobody": NOBODY, "an engine": ENGINE, "a rule": RULE, "a schedule": SCHEDULE,
    "a program with a key": KEYED, "a robot": ROBOT, "a viewer": VIEWER,
}  # fmt: skip

Send = Callable[[House, PlanProposal | None], None]


@dataclass(frozen=True)
class Intrusion:
    """Something is written to a topic by somebody who may not."""

    name: str
    send: Send
    when: When = "idle"
    by_policy: frozenset[str] = frozenset()
    """What they may where no policy asks."""


def _publish(house: House, topic: Topic[String], payload: Any) -> None:
    house.witness.publish(topic, payload)


def _decision(decision: str, by: Principal | None, **more: Any) -> Send:
    """A decision about what waits, as it was shown unless `more` says otherwise."""

    def send(house: House, shown: PlanProposal | None) -> None:
        about = {"id": shown.id, "digest": shown.digest} if shown is not None else {}
        fields = {"target": ADA, "decision": decision, **about, "by": by} | more
        _publish(house, topics.PLAN_DECISION, PlanDecision.model_validate(fields))

    return send


def _order(wire: Wire, by: Principal | None, topic: Topic[String] = topics.CHAT_ACTION) -> Send:
    def send(house: House, _: PlanProposal | None) -> None:
        fields = {"targets": [ADA], **wire, "by": by}
        _publish(house, topic, ChatAction.model_validate(fields))

    return send


def _stop(command: str, by: Principal | None) -> Send:
    def send(house: House, _: PlanProposal | None) -> None:
        fields = {"command": command, "targets": [ADA], "by": by}
        _publish(house, topics.STOP, StopCommand.model_validate(fields))

    return send


def _say(text: str, by: Principal | None, *, answers: bool = False) -> Send:
    def send(house: House, _: PlanProposal | None) -> None:
        asked = house.witness.questions.newest(ADA) if answers else None
        said = ChatInput(
            message=text, targets=(ADA,), id=f"i{next(house.count)}", by=by,
            type="response" if asked else "request", reply_to=asked.id if asked else "",
        )  # fmt: skip
        house.witness.words.add(text)
        house.language.will("interpret", ChatAction.model_validate(a("I do.", wave(), cmd=[START])))
        house.language.will("resolve", ChatAction.model_validate(fix("I do.", wave())))
        house.witness.transport.publisher(topics.CHAT_INPUT).publish(to_string(said))

    return send


def _hands_on(text: str) -> Send:
    """A robot claims that somebody said so to it."""

    def send(house: House, _: PlanProposal | None) -> None:
        house.language.will("interpret", ChatAction.model_validate(a("I do.", wave())))
        for key in ("", "i"):
            _publish(house, topics.ASIDE, Aside(actor=ADA, reply_to="q", id=key, message=text))

    return send


_EDIT: Final = [wave("what came instead")]
_CHANGES: Final = frozenset({"edited", "gave up"})


def _all(what: str, send: Callable[[Principal | None], Send], when: When = "idle") -> list[Intrusion]:
    """The same by each of the strangers; an engine and a known program may change plans by the policy."""
    changes = what.startswith(("edits a plan", "skips", "clears"))
    return [
        Intrusion(
            f"{who} {what}", send(by), when, _CHANGES if changes and by in (ENGINE, KEYED) else frozenset()
        )
        for who, by in STRANGERS.items()
    ]


CASES: Final = (
    *_all("approves", lambda by: _decision("approve", by), "proposal"),
    *_all("rejects", lambda by: _decision("reject", by), "proposal"),
    *_all("edits a card", lambda by: _decision("edit", by, steps=_EDIT), "proposal"),
    *_all("edits a plan", lambda by: _decision("edit", by, id="", steps=_EDIT), "running"),
    *_all("chooses a policy", lambda by: _decision("policy", by, id="", policy="run_at_once")),
    *_all("releases the stop", lambda by: _stop("reset", by), "latched"),
    *_all("lets go on", lambda by: _order(a(cmd=[START]), by), "paused"),
    *_all("starts what waits", lambda by: _order(a(cmd=[START]), by), "proposal"),
    *_all("skips out of a pause", lambda by: _order(a(cmd=[SKIP]), by), "paused"),
    *_all("clears and drives out of a pause", lambda by: _order(a("", drive(), cmd=[CLEAR]), by), "paused"),
    *(Intrusion(f"{who} repairs unasked", _order(fix("", valve()), by, topics.UMRF_CORRECTION), "open")
      for who, by in STRANGERS.items() if who in ("nobody", "a viewer", "a robot")),
    Intrusion("nobody orders a drive", _order(a("", *go()), NOBODY)),
    Intrusion("nobody orders a valve", _order(a("", valve()), NOBODY)),
    Intrusion("a robot orders a valve", _order(a("", valve()), ROBOT)),
    Intrusion("a viewer orders a valve", _order(a("", valve()), VIEWER)),
    Intrusion("nobody forgets by an order", _order(a("", cmd=[forget("key place")]), NOBODY), "planted"),
    Intrusion("nobody overwrites by order", _order(a(cmd=[add("key place", "river")]), NOBODY), "planted"),
    Intrusion("a viewer orders in words", _say("wave at everybody", VIEWER)),
    Intrusion("a viewer says yes", _say("yes", VIEWER), "proposal"),
    Intrusion("a viewer says no", _say("no", VIEWER), "proposal"),
    Intrusion("a viewer says carry on", _say("carry on", VIEWER), "paused"),
    Intrusion("a viewer says skip this", _say("skip this", VIEWER), "running"),
    Intrusion("a viewer cancels everything", _say("cancel everything", VIEWER), "running"),
    Intrusion("a viewer answers a question", _say("yes", VIEWER, answers=True), "failed"),
    Intrusion("a viewer answers a step", _say("yes", VIEWER, answers=True), "asked"),
    Intrusion("a robot hands on what nobody said", _hands_on("wave at everybody")),
    Intrusion("a robot hands on a yes that nobody said", _hands_on("yes"), "proposal"),
    Intrusion("an engine says yes", _say("yes", ENGINE), "proposal"),
    Intrusion("an engine answers a step", _say("yes", ENGINE, answers=True), "asked"),
    Intrusion("an engine says carry on", _say("carry on", ENGINE), "paused"),
    Intrusion("a rule says yes", _say("yes", RULE), "proposal"),
    Intrusion("a person approves without a digest", _decision("approve", KIM, digest=""), "proposal"),
    Intrusion("a person approves another digest", _decision("approve", KIM, digest="0" * 64), "proposal"),
    Intrusion("a person approves another id", _decision("approve", KIM, id="nothing"), "proposal"),
    Intrusion("a person approves for Bo", _decision("approve", KIM, target=BO), "proposal"),
    Intrusion("a person without a role that there is",
              _decision("approve", person("Kim").model_copy(update={"kind": "program"})), "proposal"),
)  # fmt: skip
