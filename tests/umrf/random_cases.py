"""Random graphs with scripted actions and commands, and how the executor plays them.

A graph is written shortly: `nodes` with their action (`*`: spontaneous, `+2`: two retries), each at the place
of its instance_id; `edges` from one to another, whether required, and what follows true, false, stopped and
error (first letters, `R`estart, `-` where nothing is said); where it begins (`entry`); what ends it (`exit`).
"""

from __future__ import annotations

import asyncio
import copy
import random
import selectors
from collections import Counter, defaultdict
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Final

from parley.clock import WallClock
from parley.errors import ActionFailure, FailureCode, GraphRefusedError
from parley.umrf.action import RunHandle, action
from parley.umrf.catalogue import Catalogue
from parley.umrf.check import check
from parley.umrf.executor import GraphRun
from parley.umrf.io import read_graph
from parley.umrf.model import Graph
from parley.umrf.transition import Transition

from . import contract_model
from .contract_model import TICKS_PER_S, Told

__all__ = ["Case", "played", "random_case"]

END: Final = 60 * TICKS_PER_S
"""When every play is stopped, if it has not come to its end."""
_RESULTS: Final = ("on_true", "on_false", "on_stopped", "on_error")
_RESPONSES: Final = {
    "r": "run", "s": "stop", "p": "pause", "b": "bypass", "i": "ignore", "R": "restart"
}  # fmt: skip


@dataclass(frozen=True)
class Case:
    """What is played."""

    graphs: dict[str, Any]
    """`g` is started, those whose key begins so are what it is modified into, others are indexed."""
    scripts: dict[str, contract_model.Script]
    """By graph and full name."""
    orders: list[list[Any]]
    """See `contract_model.play`."""

    @property
    def json(self) -> dict[str, Any]:
        """The graphs as planners send them."""
        return {key: _json("g" if key.startswith("g") else key, graph) for key, graph in self.graphs.items()}

    @property
    def told(self) -> list[tuple[str, Told]]:
        """What the contract says of it."""
        return contract_model.play(self.json, self.scripts, self.orders, most=60)


def _json(name: str, graph: Mapping[str, Any]) -> dict[str, Any]:
    refs: dict[int, dict[str, Any]] = {}
    nodes: dict[int, dict[str, Any]] = {}
    for index, said in enumerate(graph["nodes"]):
        if said:
            kind, _, retries = said.partition("+")
            refs[index] = {"name": kind.removesuffix("*"), "instance_id": index}
            nodes[index] = refs[index] | {"type": "spontaneous" if kind.endswith("*") else "sync"}
            if retries:
                nodes[index]["parley"] = {"retries": int(retries)}
    for parent, child, required, said in graph["edges"]:
        nodes[parent].setdefault("children", []).append(refs[child])
        nodes[child].setdefault("parents", []).append(_relation(refs[parent], required, said))
    return {
        "graph_name": name,
        "graph_entry": [refs[index] for index in graph["entry"]],
        "graph_exit": [_relation(refs[index], required, said) for index, required, said in graph["exit"]],
        "actions": list(nodes.values()),
    }


def _relation(ref: Mapping[str, Any], required: bool, said: str) -> dict[str, Any]:
    stated = [
        f"{result} -> {_RESPONSES[letter]}"
        for result, letter in zip(_RESULTS, said, strict=True)
        if letter != "-"
    ]
    return {**ref, "required": bool(required), "conditions": stated}


# -- making them ----------------------------------------------------------------------------------------


def random_case(seed: int) -> Case:
    """A case of which the contract says what happens; the same for the same seed."""
    for attempt in range(1000):
        luck = random.Random(f"{seed} {attempt}")
        graphs = _graphs(luck)
        case = Case(graphs, _scripts(luck, graphs), _orders(luck, graphs))
        read = {key: read_graph(graph) for key, graph in case.json.items()}
        catalogue = Catalogue(SPECS, _indexed(read))
        if any(check(graph, catalogue) for graph in read.values()):
            continue  # something cannot be reached, or a loop waits for itself
        try:
            if case.told:
                return case
        except contract_model.TieError:
            continue
    raise AssertionError(seed)


def _indexed(graphs: Mapping[str, Graph]) -> list[Graph]:
    return [graph for key, graph in graphs.items() if not key.startswith("g")]


def _graphs(luck: random.Random) -> dict[str, Any]:
    inside = luck.choice([[], [], ["Inner"], ["Inner", "Deep"]])
    graphs = {"g": _graph(luck, inside[:1], luck.randint(1, 8))}
    for index, name in enumerate(inside):
        graphs[name] = _graph(luck, inside[index + 1 :], luck.randint(1, 3 - index))
    if luck.random() < 0.25:
        graphs |= {key: _changed(luck, graphs["g"]) for key in ("g1", "g2")}
    return graphs


def _graph(luck: random.Random, inner: list[str], count: int) -> dict[str, Any]:
    kinds = ["Do", "Do", "Insist", *inner * luck.randint(1, 4)]
    wild, often, at_once = luck.random(), luck.choice([0.0, 0.0, 0.1, 0.3]), luck.choice([0.0, 0.5])
    edges: list[list[Any]] = []
    for index in range(1, count):
        for parent in luck.sample(range(index), min(index, luck.choice([1, 1, 2, 3]))):
            edges.append([parent, index, int(luck.random() < 0.7 - at_once), _said(luck, wild)])
    for _ in range(luck.choice([0, 0, 1, 1, 2])):  # ways back
        way = [luck.randrange(count), luck.randrange(count)]
        if not any(edge[:2] == way for edge in edges):
            edges.append([*way, 0, _said(luck, wild)])
    parents = {edge[0] for edge in edges}
    ends = [index for index in range(count) if index not in parents or luck.random() < 0.15]
    return {
        "nodes": [_node(luck, luck.choice(kinds), often) for _ in range(count)],
        "edges": edges,
        "entry": [index for index in range(count) if index == 0 or luck.random() < at_once],
        "exit": [[index, int(luck.random() < 0.7), _said(luck, wild / 2)] for index in ends],
    }


def _node(luck: random.Random, kind: str, often: float) -> str:
    star = "*" if kind == "Do" and luck.random() < often else ""
    return kind + star + (f"+{luck.randint(1, 2)}" if luck.random() < 0.2 else "")


def _said(luck: random.Random, wild: float) -> str:
    return "".join(luck.choice([*_RESPONSES]) if luck.random() < wild else "-" for _ in _RESULTS)


def _changed(luck: random.Random, graph: Mapping[str, Any]) -> dict[str, Any]:
    """Another form of a graph: other conditions, and often one node less or one more."""
    changed: dict[str, Any] = copy.deepcopy(dict(graph))
    count, wild = len(changed["nodes"]), luck.random()
    for relation in [*changed["edges"], *changed["exit"]]:
        if luck.random() < 0.3:
            relation[-2:] = [int(luck.random() < 0.75), _said(luck, wild)]
    what, index = luck.choice(["less", "more", "neither"]), luck.randrange(count)
    if what == "more":
        changed["nodes"].append(_node(luck, "Do", 0.1))
        changed["edges"].append([index, count, 1, _said(luck, wild)])
        changed["exit"].append([count, 1, _said(luck, wild)])
    elif what == "less" and count > 1:
        changed["nodes"][index] = ""
        changed["edges"] = [edge for edge in changed["edges"] if index not in edge[:2]]
        changed["entry"] = [entry for entry in changed["entry"] if entry != index]
        changed["exit"] = [relation for relation in changed["exit"] if relation[0] != index]
    return changed


def _names(graph: Mapping[str, Any]) -> list[str]:
    kinds = [said.partition("+")[0].removesuffix("*") for said in graph["nodes"]]
    return [f"{kind}_{index}" for index, kind in enumerate(kinds) if kind]


def _scripts(luck: random.Random, graphs: Mapping[str, Any]) -> dict[str, contract_model.Script]:
    """Of each node in each place in which it may run."""
    found: dict[str, contract_model.Script] = {}

    def add(place: str, graph: Mapping[str, Any]) -> None:
        for name in _names(graph):
            kind, _, index = name.partition("_")
            if kind in graphs:
                add(f"{place}__{kind}__{index}", graphs[kind])
            else:
                found[f"{place}/{name}"] = [_run(luck) for _ in range(luck.randint(1, 3))]

    for key, graph in graphs.items():
        if key.startswith("g"):
            add("g", graph)
    return found


def _run(luck: random.Random) -> tuple[int, str, int]:
    lag = luck.randint(5200, 9000) if luck.random() < 0.05 else luck.randint(20, 3000)
    return luck.randint(100, 6000), luck.choice("tttttttfffexen"), lag


def _orders(luck: random.Random, graphs: Mapping[str, Any]) -> list[list[Any]]:
    wanted = luck.choice([[], ["pause", "resume"], ["stop"], ["resume", "end", "continue", "pause"]])
    if "g1" in graphs:
        wanted = [*wanted, "modify", "modify and continue"]
    orders: list[list[Any]] = []
    for ticks in sorted(luck.sample(range(1, 20_000), luck.randint(0, 3 * len(wanted)))):
        key = luck.choice(["g1", "g2"])
        match luck.choice(wanted):
            case "continue":
                orders.append([ticks, "resume", luck.choice(_names(graphs["g"]))])
            case "end":
                orders.append([ticks, "end", luck.choice(_names(graphs["g"]))])
            case "modify":
                orders.append([ticks, "modify", key])
            case "modify and continue":
                orders.append([ticks, "modify", key, luck.choice(_names(graphs[key]))])
            case other:
                orders.append([ticks, other])
    return [*orders, [END // 2, "resume"], [END, "stop"]]


# -- playing them with the executor ---------------------------------------------------------------------


class _Jumping(selectors.DefaultSelector):
    """Does not wait: time jumps to when something is to happen."""

    passed_s = 0.0

    def select(self, timeout: float | None = None) -> Any:
        assert timeout is not None, "nothing would ever happen any more"
        self.passed_s += timeout
        return super().select(0)


class JumpingLoop(asyncio.SelectorEventLoop):
    """A loop whose time passes in jumps; what takes no time happens in the order of its turns."""

    def __init__(self) -> None:
        self._jumping = _Jumping()
        super().__init__(self._jumping)

    def time(self) -> float:
        return self._jumping.passed_s


class _LoopClock(WallClock):
    def now_s(self) -> float:
        return asyncio.get_running_loop().time()


class _Theatre:
    """The actions, told by a script what to do."""

    def __init__(self, scripts: Mapping[str, contract_model.Script]) -> None:
        self._scripts, self._begun = scripts, Counter[str]()

    async def act(self, ctx: RunHandle, *, insists: bool) -> bool:
        key = f"{ctx.graph_name}/{ctx.node}"
        script = self._scripts[key]
        ticks, outcome, lag = script[self._begun[key] % len(script)]
        self._begun[key] += 1
        try:
            await asyncio.sleep(ticks / TICKS_PER_S)
            while ctx.paused and not insists:
                await ctx.wait_while_paused()
                await asyncio.sleep(lag / TICKS_PER_S)
        except asyncio.CancelledError:
            await asyncio.sleep(lag / TICKS_PER_S)
            raise
        if outcome == "x":
            raise RuntimeError("as planned")
        if outcome in "en":
            raise ActionFailure(FailureCode.BLOCKED if outcome == "e" else FailureCode.DECLINED, "as planned")
        return outcome == "t"


@dataclass(frozen=True)
class _Handle:
    """What an action here gets: its handle, and who says what it does."""

    run: RunHandle
    theatre: _Theatre


@action
async def do(ctx: _Handle) -> bool:
    """Do as scripted, and stand still in a pause."""
    return await ctx.theatre.act(ctx.run, insists=False)


@action(pausable=False)
async def insist(ctx: _Handle) -> bool:
    """Do as scripted, whatever is said of pauses."""
    return await ctx.theatre.act(ctx.run, insists=True)


SPECS: Final = (do.spec, insist.spec)

_LETTERS: Final = {
    "RUNNING": "R", "STOPPING": "S", "PAUSED": "P", "PAUSE_REQUESTED": "Q", "FINISHED": "F", "ERROR": "E",
    "STOPPED": "T", "HALTED": "H",
}  # fmt: skip


class _Watch:
    """One run of one graph and what it told."""

    def __init__(self, name: str) -> None:
        self.name, self.told, self.count = name, defaultdict[str, str](str), 0
        self.run: GraphRun
        self.replaced = False
        """Whether there is a newer one of that name; then it is not listened to any more."""

    def __call__(self, change: Transition) -> None:
        assert change.sequence == self.count, "every change is told once, in order"
        self.count += 1
        if change.kind == "progress" or self.replaced:
            return
        letter = "b" if change.cause == "bypass" else _LETTERS[change.state]
        result = change.result.value.removeprefix("on_")[0] if change.result is not None else ""
        self.told[change.node] += letter + result


async def _play(case: Case) -> list[tuple[str, Told]]:
    theatre, clock, runs = _Theatre(case.scripts), _LoopClock(), list[_Watch]()
    graphs = {key: read_graph(graph) for key, graph in case.json.items()}
    catalogue = Catalogue(SPECS, _indexed(graphs))

    def make(graph: Graph, **options: Any) -> GraphRun:
        for old in runs:
            old.replaced = old.replaced or old.name == graph.name
        watch = _Watch(graph.name)
        runs.append(watch)
        watch.run = GraphRun(
            graph, catalogue, actor="A", clock=clock, make_context=lambda run: _Handle(run, theatre),
            observer=watch, make_inner=make, **options,
        )  # fmt: skip
        return watch.run

    run, loop = make(graphs["g"]), asyncio.get_running_loop()
    run.start()
    for ticks, order, *arguments in case.orders:
        await asyncio.sleep(ticks / TICKS_PER_S - loop.time())
        before = [watch.count for watch in runs]
        try:
            if order == "modify":
                arguments[0] = graphs[arguments[0]]
            getattr(run, "end_node" if order == "end" else order)(*arguments)
        except GraphRefusedError as error:
            assert error.problems
            assert [watch.count for watch in runs] == before, "a refusal changes nothing"
    await asyncio.sleep(END / TICKS_PER_S)
    await run.close()
    for watch in runs:
        assert watch.run.idle
        if watch.replaced:
            continue
        shown = [(item.full_name, item.state.value) for item in watch.run.snapshot().nodes]
        for name, state in shown:
            told = [letter for letter in watch.told.get(name, "") if letter.isupper()]
            assert _LETTERS.get(state, "") in ("", *told[-1:]), "what is shown was told"
    assert asyncio.all_tasks() == {asyncio.current_task()}
    return [(watch.name, dict(watch.told)) for watch in runs]


def played(case: Case) -> list[tuple[str, Told]]:
    """What the executor makes of it."""
    loop = JumpingLoop()
    try:
        return loop.run_until_complete(_play(case))
    finally:
        loop.close()
