"""The audit log's node: what crosses the topics is written down, and a full disk holds nobody up."""

from __future__ import annotations

import asyncio
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager
from dataclasses import dataclass

import pytest

from parley.agents.audit_log import AuditLog
from parley.clock import Clock, WallClock
from parley.gate.audit_store import AuditStore
from parley.gate.audit_text import told, who_of
from parley.gate.heard import labels
from parley.messages import topics
from parley.messages.audit import AuditEntry, AuditEvent, AuditList, GetAudit
from parley.messages.chat import ActionCall, ChatAction, ChatInput, Press, SystemCommand
from parley.messages.memory import AddToMemory, MemoryBody, MemoryEvent
from parley.messages.principal import Principal, person
from parley.messages.pvf import Parameter
from parley.messages.ros import ChatRequest
from parley.messages.status import (
    ActionInfo,
    ActorStatus,
    GraphEvent,
    PlanDecision,
    PlanProposal,
    PlanStep,
    Rejection,
    RejectionProblem,
    StopCommand,
    StopReport,
)
from parley.messages.topics import Topic
from parley.messages.wire import decode, encode, to_string
from parley.transport.local import LocalTransport
from tests.web.rig import HandClock

KIM = person("Kim", device="phone")
ENGINE = Principal(kind="engine", name="builtin")
GO = ActionCall(name="GoTo", input_parameters={"target": Parameter("string", "box")})


@dataclass
class Rig:
    transport: LocalTransport
    store: AuditStore
    node: AuditLog
    trouble: asyncio.Event
    """Set when people are told that the file cannot be written, or can again."""
    told: list[str]

    async def pages(self, count: int) -> None:
        """Bound the file as a full disk does."""
        await self.store._database.run(lambda db: db.execute(f"PRAGMA max_page_count = {count}").fetchall())

    async def tell(self, topic: Topic, payload: object) -> None:  # type: ignore[type-arg]
        publisher = self.transport.publisher(topic)
        publisher.publish(to_string(payload))  # type: ignore[arg-type]
        await asyncio.sleep(0)  # it is carried

    async def log(self, **wanted: object) -> tuple[AuditEntry, ...]:
        request = ChatRequest(encode(GetAudit.model_validate(wanted)))
        answer = await self.transport.call(topics.GET_AUDIT, request, timeout_s=5)
        return decode(AuditList, answer.response).entries


@asynccontextmanager
async def rig(waiting: int = 100, clock: Clock | None = None) -> AsyncIterator[Rig]:
    trouble, said = asyncio.Event(), list[str]()

    def tell(text: str) -> None:
        said.append(text)
        trouble.set()

    async with (
        LocalTransport() as transport,
        await AuditStore.open(":memory:", WallClock()) as store,
        AuditLog(transport, store, clock or WallClock(), tell=tell, retry_s=0.001, waiting=waiting) as node,
    ):
        yield Rig(transport, store, node, trouble, said)


@pytest.mark.parametrize("state", ["finished", "failed"])
def test_a_search_stands_in_the_log_as_the_step_that_it_is_made_for(state: str) -> None:
    found = PlanStep.model_validate({"action": GO, "label": "Find it", "state": state, "for_next": True})
    assert labels([found, PlanStep(action=GO, label="Go there")]) == ["Go there"]


async def test_an_order_stands_in_the_log_from_the_words_to_the_end() -> None:
    async with rig() as r:
        await r.tell(topics.CHAT_INPUT, ChatInput(message="go to the box", targets=("Ada",), id="m1", by=KIM))
        order = ChatAction(queue=(GO,), targets=("Ada",), by=ENGINE, reply_to="m1")
        await r.tell(topics.CHAT_ACTION, order)
        proposal = PlanProposal(
            id="p",
            target="Ada",
            steps=(GO, GO),
            labels=("Find it", "Go to the box"),
            lines=("Go to the box",),
            digest="d",
            by=ENGINE,
        )
        await r.tell(topics.PLAN, proposal)
        await r.tell(topics.PLAN, proposal)
        yes = PlanDecision(id="p", target="Ada", decision="approve", digest="d", by=person("Lee"))
        await r.tell(topics.PLAN_DECISION, yes)
        event = GraphEvent(actor="Ada", graph_name="g", sequence=0, kind="graph", state="RUNNING")
        await r.tell(topics.GRAPH_EVENTS, event)
        await r.tell(topics.GRAPH_EVENTS, event.model_copy(update={"state": "FINISHED", "sequence": 1}))
        entries = (await r.log(robot="Ada"))[::-1]
        assert [str(told(entry)) for entry in entries] == [
            "Kim (phone) said “go to the box” to Ada.",
            "The language engine builtin wants this from Ada: Go to (box).",
            "Ada waits for a yes: Go to the box.",
            "Lee said yes to Ada: Go to the box.",
            "Ada began: Go to the box. Lee said yes to it.",
            "Ada has finished: Go to the box.",
        ]
        began = entries[-2]
        assert (began.detail["asked"], began.detail["asked_by"]["name"], began.digest) == (
            "go to the box",
            "Kim",
            "d",
        )


@pytest.mark.parametrize(
    ("effect", "detail", "shown"),
    [
        ("edit", {"command": "skip"}, "Kim (phone) changed the plan of Ada: a step is left out."),
        ("policy", {"policy": "ask_first"}, "Kim (phone) chose when Ada asks first: always."),
        ("edit", {"name": "skip"}, "Kim (phone) changed the plan of Ada: skip."),
    ],
)
def test_what_programs_call_a_command_or_a_policy_stands_in_the_log_in_words(
    effect: str, detail: dict[str, str], shown: str
) -> None:
    assert told(AuditEvent(effect=effect, by=KIM, robot="Ada", detail=detail)) == shown


@pytest.mark.parametrize(
    ("by", "shown"),
    [
        (Principal(kind="robot", name="Ada/Inspect"), "Ada wants this remembered: cup location."),
        (Principal(kind="person", name="operator"), "Somebody wants this remembered: cup location."),
    ],
)
def test_what_memories_call_people_and_things_stands_in_the_log_in_words(by: Principal, shown: str) -> None:
    assert told(AuditEvent(effect="remember", by=by, detail={"name": "cup_location"})) == shown


async def test_a_wish_stands_in_the_log_in_the_words_of_the_robots_own_plans() -> None:
    known = ActionInfo(name=GO.name, inputs={"target": "string"}, phrases=("go to {target}",))
    async with rig() as r:
        await r.tell(topics.ACTOR_STATUS, ActorStatus(actor="Ada", catalogue=(known,)))
        await r.tell(topics.CHAT_ACTION, ChatAction(queue=(GO,), targets=("Ada",), by=ENGINE))
        await r.tell(topics.PLAN_DECISION, PlanDecision(target="Ada", decision="edit", steps=(GO,), by=KIM))
        assert [str(told(entry)) for entry in await r.log(robot="Ada")] == [
            "Kim (phone) changed the plan of Ada: Go to “box”.",
            "The language engine builtin wants this from Ada: Go to “box”.",
        ]


async def test_who_holds_a_robot_while_words_are_read_releases_no_stop() -> None:
    async with rig() as r:
        for _way in ("its own line", "the topic"):
            await r.tell(topics.STOP, StopCommand(targets=("Ada",), id="s1", by=KIM))
        await r.tell(topics.STOP, StopCommand(command="hold", targets=("Ada",), id="m1", by=KIM))
        await r.tell(topics.STOP, StopCommand(command="go_on", id="m1"))
        assert [entry.effect for entry in await r.log(robot="Ada")] == ["stop"]


async def test_a_yes_of_nobody_is_no_yes_of_the_one_who_asked() -> None:
    async with rig() as r:
        await r.tell(topics.PLAN, PlanProposal(id="p", target="Ada", steps=(GO,)))
        await r.tell(topics.PLAN_DECISION, PlanDecision(id="p", target="Ada", decision="approve", by=ENGINE))
        event = GraphEvent(actor="Ada", graph_name="g", sequence=0, kind="graph", state="RUNNING")
        await r.tell(topics.GRAPH_EVENTS, event)
        assert "approved_by" not in (await r.log(effect="start"))[0].detail


async def test_a_button_that_is_sent_again_stands_in_the_log_once() -> None:
    press = Press(page="p", number=1, to="r")
    pause = ChatAction(system_cmd=(SystemCommand(command="stop"),), targets=("Ada",), by=KIM, press=press)
    no = PlanDecision(id="p", target="Ada", decision="reject", by=KIM)
    async with rig() as r:
        for _ in range(2):
            await r.tell(topics.CHAT_ACTION, pause)
            await r.tell(
                topics.PLAN_DECISION,
                no.model_copy(update={"press": press.model_copy(update={"number": 2})}),
            )
        assert sorted(entry.effect for entry in await r.log(robot="Ada")) == ["pause", "reject"]


@pytest.mark.parametrize(
    ("topic", "payload", "sentence"),
    [
        (topics.STOP, StopCommand(targets=("Ada",), by=KIM), "Kim (phone) stopped Ada."),
        (topics.STOP, StopCommand(command="reset", by=KIM), "Kim (phone) released the stop of all robots."),
        (topics.STOP_REPORT, StopReport(actor="Ada", state="at_rest"), "Ada stands still."),
        (
            topics.PLAN_DECISION,
            PlanDecision(target="Ada", decision="policy", policy="ask_first", by=KIM),
            "Kim (phone) chose when Ada asks first: always.",
        ),
        (
            topics.REJECTION,
            Rejection(source="planner", target="Ada", what="/parley/plan_decision",
                      problems=(RejectionProblem(message="Only a person may say yes."),)),
            "Refused (Ada): Only a person may say yes.",
        ),
        (topics.AUDIT, AuditEvent(effect="sign_in", by=KIM), "Kim (phone) signed in."),
        (topics.AUDIT, AuditEvent(effect="sign_in", outcome="refused"), "Somebody was not let in."),
        (
            topics.AUDIT,
            AuditEvent(effect="sign_in", outcome="refused", detail={"name": "Kim"}),
            "Somebody was not let in as “Kim”.",
        ),
        (
            topics.CHAT_INPUT,
            ChatInput(message="go\n7 Lee said yes\u202e", targets=("Ada",), by=KIM),
            "Kim (phone) said “go 7 Lee said yes⟨U+202E⟩” to Ada.",
        ),
    ],
)  # fmt: skip
async def test_what_else_is_heard_is_told_in_a_sentence(topic: Topic, payload: object, sentence: str) -> None:  # type: ignore[type-arg]
    async with rig() as r:
        await r.tell(topic, payload)
        assert str(told((await r.log())[0])) == sentence


async def test_a_memory_counts_when_it_is_durable_and_is_put_down_to_whoever_told_it() -> None:
    async with rig() as r:
        body = MemoryBody(data="The box is red.", source="Kim", way="told", words="the box is red")
        await r.tell(topics.ADD_TO_MEMORY, AddToMemory({"box": body}))
        assert [entry.effect for entry in await r.log()] == ["open"]
        await r.tell(topics.MEMORY_EVENT, MemoryEvent(kind="added", name="box"))
        (entry,) = await r.log(effect="remember")
        assert (entry.by, entry.words) == (Principal(kind="person", name="Kim"), "the box is red")
        await r.tell(topics.MEMORY_EVENT, MemoryEvent(kind="removed", name="box", by=person("Ann")))
        (entry,) = await r.log(effect="forget")
        assert (entry.by, entry.words) == (person("Ann"), "the box is red")


async def test_nobody_else_writes_what_the_log_says_about_itself() -> None:
    async with rig() as r:
        await r.tell(topics.AUDIT, AuditEvent(effect="prune", detail={"last": "9:x"}))
        assert [entry.effect for entry in await r.log()] == ["open"]


async def test_while_the_disk_is_full_nothing_waits_and_what_did_not_fit_is_written_down() -> None:
    async with rig(waiting=3) as r:
        await r.log()
        await r.pages(1)
        r.node.write([AuditEvent(effect="speak", words=f"{n} {'x' * 3000}") for n in range(50)])
        await r.trouble.wait()
        r.trouble.clear()
        await r.pages(100_000)
        await r.trouble.wait()
        await r.node.flush()
        assert [entry.words.split()[0] for entry in await r.log(effect="speak")] == ["2", "1", "0"]
        (gap,) = await r.log(effect="gap")
        assert gap.detail["dropped"] == 47
        assert "lacks 47 messages" in r.told[-1]
        assert (await r.store.check()).problem == ""


async def test_what_came_faster_than_it_was_heard_is_written_down_as_a_gap_and_told() -> None:
    async with rig(waiting=10_000) as r:
        beats = r.transport.publisher(topics.ACTOR_STATUS)
        for _ in range(1100):
            beats.publish(to_string(ActorStatus(actor="Ada")))  # of these none is an entry
        publisher = r.transport.publisher(topics.CHAT_INPUT)
        for number in range(1005):
            publisher.publish(to_string(ChatInput(message="hello", id=f"m{number}")))
        assert len(await r.log(effect="speak", limit=1000)) == 1000
        (gap,) = await r.log(effect="gap")
        assert gap.detail["dropped"] == 5
        assert len(r.told) == 1 and "lacks 5 messages" in r.told[0]


async def test_that_nothing_was_heard_of_a_robot_is_written_down_once_it_is_heard_again() -> None:
    clock = HandClock()
    async with rig(clock=clock) as r:
        for ahead_s, state in ((0, "idle"), (5, "idle"), (47, "idle"), (48, "leaving"), (99, "idle")):
            clock.ahead_s = ahead_s
            await r.tell(topics.ACTOR_STATUS, ActorStatus.model_validate({"actor": "Ada", "state": state}))
            await r.log()
        (gap,) = await r.log(effect="gap")
        assert gap.detail["until_unix_ms"] - gap.detail["since_unix_ms"] == 42_000
        assert str(told(gap)) == "Nothing had been heard of Ada for 42 s."


@pytest.mark.parametrize(
    ("label", "who"),
    [
        ("built-in language engine (no language model)", "The built-in language engine"),
        ("language model m1; if it gives no answer: built-in language engine", "The language model m1"),
        ("scripted", "The language engine scripted"),
    ],
)
def test_an_engine_is_named_once(label: str, who: str) -> None:
    assert who_of(Principal(kind="engine", name=label)) == who
