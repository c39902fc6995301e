"""The contract of running graphs once more, in the fewest words that run: what an executor is compared with.

Written from `spec/umrf.md` 8, 10 and 11 and from the differences that `docs/engine.md` lists, without any
code of the product. Graphs are JSON as planners send it. Each run of an action is scripted: how long it
takes, how it ends, and how long it goes on when told to stop or to go on after a pause. Time is counted in
ticks and jumps from one end to the next, so a play is a pure function of what is given.
"""

from __future__ import annotations

import heapq
import itertools
from collections import Counter, defaultdict
from collections.abc import Callable, Mapping, Sequence
from functools import partial
from typing import Any

__all__ = ["STOP_TICKS", "TICKS_PER_S", "TieError", "play"]

TICKS_PER_S = 1024
"""A power of two: sums of ticks are exact as seconds, too."""
STOP_TICKS = 5 * TICKS_PER_S

Script = Sequence[tuple[int, str, int]]
"""For each run of a node, over and over: ticks it takes; `t`rue, `f`alse, `e`rror, e`x`ception or `n`o by a
person; ticks that it goes on after being told to stop, or after a pause that outlasted it."""
Told = dict[str, str]
"""Empty name -> the states of the graph, node -> its states, in order; see `_TOLD`."""

_DEFAULTS = {"on_true": "run", "on_false": "run", "on_stopped": "ignore", "on_error": "bypass"}
_RESULTS = {"t": "on_true", "f": "on_false", "s": "on_stopped", "e": "on_error"}
_ACTIVE = "RSPQ"
"""Of a node: RUNNING, STOPPING, PAUSED, PAUSE_REQUESTED; else `-`, F(INISHED) or E(RROR). Of a graph also
(s)T(OPPED) and H(ALTED). A small letter says with which result, `b` what a bypass passed on."""
_ENDED = "FTE"


class TieError(Exception):
    """Two things happen at the same time, and the contract does not say which comes first."""


def play(
    graphs: Mapping[str, Any],
    scripts: Mapping[str, Script],
    orders: Sequence[Sequence[Any]],
    *,
    most: int = 1000,
) -> list[tuple[str, Told]]:
    """Play the graph `g` to its end; its name and what it told, then the same of each graph that ran inside.

    Args:
        graphs: As JSON, by name; those of others are indexed.
        scripts: Of the nodes, by graph and full name: `graph/Node_0`.
        orders: When somebody commands what, and its arguments: `pause`; `resume`, which may name a node to
            continue from; `stop`; `end` a node; `modify` into the graph of a key, and continue from a node.
        most: How often nodes may begin to run, before it is given up.

    Raises:
        TieError: The contract does not say what happens.
    """
    world = _World(graphs, scripts, most)
    run = _Run(world, graphs["g"], "")
    world.at(0, run.start)
    for ticks, order, *arguments in orders:
        world.at(ticks, getattr(run, order), *arguments)
    world.pass_time()
    return [(run.name, dict(run.told)) for run in world.runs]


class _World:
    """Time, and what all graphs share."""

    def __init__(self, graphs: Mapping[str, Any], scripts: Mapping[str, Script], most: int) -> None:
        self.graphs, self.scripts = graphs, scripts
        self.now = self.turn = 0
        self.begun: Counter[str] = Counter()
        self.runs: list[_Run] = []
        self._left, self._urgent = most, 0
        self._events: list[tuple[int, int, int, Callable[[], bool], Callable[[], None]]] = []
        self._order = itertools.count()

    @property
    def moment(self) -> tuple[int, int]:
        """When it is, and which of the things that happen then is going on."""
        return self.now, self.turn

    def at(
        self, ticks: int, do: Callable[..., None], *arguments: Any, still: Callable[[], bool] = lambda: True
    ) -> None:
        """Do something later, if it is `still` to be done then."""
        if ticks == self.now and self._urgent:
            raise TieError
        do_it: Callable[[], None] = partial(do, *arguments)
        heapq.heappush(self._events, (ticks, next(self._order), self.now, still, do_it))

    def at_once(self, do: Callable[..., None], *arguments: Any) -> None:
        """Do something after all that goes on now; what else waits for that must not depend on it."""
        if any(ticks == self.now and still() for ticks, _, _, still, _ in self._events):
            raise TieError
        self.at(self.now, do, *arguments)
        self._urgent = 1

    def pass_time(self) -> None:
        """Until nothing is left to happen."""
        while self._events:
            ticks, _, since, still, do = heapq.heappop(self._events)
            if not still():
                continue
            if since < ticks == self.now and ticks:
                raise TieError
            self.now, self.turn, self._urgent = ticks, self.turn + 1, 0
            do()

    def script(self, key: str) -> tuple[int, str, int]:
        """Of the next run of a node."""
        self._left -= 1
        if self._left < 0:
            raise TieError
        script = self.scripts[key]
        self.begun[key] += 1
        return script[(self.begun[key] - 1) % len(script)]


class _Node:
    def __init__(self, raw: Mapping[str, Any]) -> None:
        self.name = f"{raw['name']}_{raw.get('instance_id', 0)}"
        self.kind = raw["name"]
        self.spontaneous = raw["type"] == "spontaneous"
        self.state = "-"
        self.seen: set[str] = set()
        self.going_on = False
        """Whether its action has not ended, even if it was given up."""
        self.begun = self.due = self.paused = self.restart = False
        self.attempt = self.lag = self.number = 0
        self.begun_at = 0, 0
        self.outcome = ""
        self.inner: _Run | None = None
        self.round: tuple[set[str], str] | None = None
        """Of a spontaneous node that ended: whose ends it waits for before it goes on, and how it ended."""
        self.round_held = False
        self.relate(raw)

    def relate(self, raw: Mapping[str, Any]) -> None:
        self.parents = {_name(item): _edge(item) for item in raw.get("parents", ())}
        self.children = [_name(item) for item in raw.get("children", ())]
        self.retries = raw.get("parley", {}).get("retries", 0)

    @property
    def active(self) -> bool:
        return self.state in _ACTIVE

    @property
    def between(self) -> bool:
        """Whether it is between two rounds, in which it counts as running (10.7)."""
        return self.round is not None and self.round[1] in "tf"

    @property
    def ready(self) -> bool:
        return all(name in self.seen for name, (required, _) in self.parents.items() if required)


def _name(relation: Mapping[str, Any]) -> str:
    return f"{relation['name']}_{relation.get('instance_id', 0)}"


def _edge(relation: Mapping[str, Any]) -> tuple[bool, dict[str, str]]:
    said = (item.replace(" ", "").split("->") for item in relation.get("conditions", ()))
    return relation.get("required", True), _DEFAULTS | dict(said)


class _Run:
    """One run of one graph."""

    def __init__(self, world: _World, raw: Mapping[str, Any], name: str) -> None:
        self.world, self.name = world, name or raw["graph_name"]
        self.replaced = False
        for old in world.runs:  # who is replaced is stopped, if it must be, and tells nothing (11.6)
            old.replaced = old.replaced or old.name == self.name
        world.runs.append(self)
        self.state, self.result = "-", ""
        self.told: defaultdict[str, str] = defaultdict(str)
        self.pausing = self.stop_failed = False
        self.held: list[tuple[_Node, str]] = []
        """What ended during a pause, and how; `again` for what is to run again."""
        self.outer: tuple[_Run, _Node] | None = None
        self.inner: list[_Run] = []
        self.nodes: dict[str, _Node] = {}
        self.exit_seen: set[str] = set()
        self.begun = False
        self.take(raw)

    def take(self, raw: Mapping[str, Any]) -> None:
        """Become this graph; nodes that are there already stay as they are, and so do seen edges."""
        old, self.nodes = self.nodes, {}
        for item in raw["actions"]:
            node = old.pop(_name(item), None) or _Node(item)
            node.relate(item)
            node.seen &= node.parents.keys()
            self.nodes[node.name] = node
        if any(node.going_on or node.round is not None for node in old.values()):
            raise TieError
        self.entry = [_name(item) for item in raw["graph_entry"]]
        self.exit = {_name(item): _edge(item) for item in raw["graph_exit"]}
        self.exit_seen &= self.exit.keys()
        for name in self.exit:
            self.nodes[name].children.append("")

    # -- commands (11) --------------------------------------------------------------------------------------

    def start(self) -> None:
        self.begun = True
        self.become("R")
        for name in self.entry:
            if self.nodes[name].ready:
                self.run(self.nodes[name])
        self.settle()

    def pause(self) -> None:
        self.pausing = self.pausing or self.state == "R"
        for node in self.active():
            self.pause_node(node)
        for inner in self.inner:
            inner.pause()
        self.settle()

    def resume(self, continue_from: str = "") -> None:
        if self.state == "S" or (continue_from and (self.state in _ENDED or not self.can_run(continue_from))):
            return
        self.pausing = False
        if self.state == "P" or (self.state == "H" and continue_from):
            self.become("R")
        still = [node for node in self.nodes.values() if node.state in "PQ"]
        for node in self.nodes.values():
            node.round_held = False
        for node in still:
            self.go_on(node)
        for inner in self.inner:
            if inner not in [node.inner for node in still]:  # once each, or an edge's pause would not last
                inner.resume()
        held, self.held = self.held, []
        for node, result in held:
            if result == "again":
                self.run(node)
            else:
                self.follow(node, result)
        if continue_from and self.state == "R":
            self.run(self.nodes[continue_from])
        self.settle()

    def stop(self) -> None:
        if self.state in "RPH":
            self.pausing = self.stop_failed = False
            self.held.clear()
            self.become("S")
        for node in self.active():
            self.stop_node(node)
        for inner in self.inner:
            inner.stop()
        self.settle()

    def modify(self, key: str, continue_from: str = "") -> None:
        names = {_name(item) for item in self.world.graphs[key]["actions"]}
        if self.state in "SFTE" or any(node.name not in names for node in self.active()):
            return
        if continue_from in self.nodes and not self.can_run(continue_from):
            return
        self.take(self.world.graphs[key])
        self.held = [item for item in self.held if item[0].name in names]
        self.become(self.state, self.result)
        if continue_from:
            self.resume(continue_from)

    def can_run(self, name: str) -> bool:
        """Whether there is such a node, and no action of it that was given up still goes on."""
        return name in self.nodes and (self.nodes[name].active or not self.nodes[name].going_on)

    def end(self, name: str) -> None:
        if name in self.nodes:
            self.stop_node(self.nodes[name])
            self.settle()

    # -- nodes ----------------------------------------------------------------------------------------------

    def active(self) -> list[_Node]:
        return [node for node in self.nodes.values() if node.active]

    def tell(self, node: _Node, state: str, result: str = "") -> None:
        if not self.replaced:
            self.told[node.name] += state + result
        if state != "b":
            node.state = state

    def run(self, node: _Node, attempt: int = 1) -> None:
        if node.going_on or node.round is not None:
            return  # who is going on ignores a trigger
        node.going_on, node.attempt, node.restart = True, attempt, False
        node.begun = node.due = node.paused = False
        node.begun_at, node.number, node.inner = self.world.moment, node.number + 1, None
        self.tell(node, "R")
        if node.kind in self.world.graphs:
            self.world.at(self.world.now, self.begin, node, node.number)
        else:
            self.begin(node, node.number)

    def begin(self, node: _Node, number: int) -> None:
        if node.paused or node.begun or not node.going_on or node.number != number:
            return
        node.begun = True
        if node.kind in self.world.graphs:
            name = f"{self.name}__{node.kind}__{node.name.rpartition('_')[2]}"
            inner = node.inner = _Run(self.world, self.world.graphs[node.kind], name)
            inner.outer = self, node
            for old in self.inner:  # which is discarded (11.1)
                if old.name == name:
                    old.stop()
            self.inner.append(inner)
            inner.start()
        else:
            ticks, node.outcome, node.lag = self.world.script(f"{self.name}/{node.name}")
            self.later(node, ticks, self.come_to_end)

    def later(self, node: _Node, ticks: int, do: Callable[..., None], *arguments: Any) -> None:
        """Do something with this run of the node, if it is still the same then."""
        number = node.number
        self.world.at(
            self.world.now + ticks,
            do,
            node,
            *arguments,
            still=lambda: node.number == number and node.going_on,
        )

    def come_to_end(self, node: _Node) -> None:
        if node.state == "S" or not node.active:
            return  # the stop says when it ends
        if node.paused and node.kind == "Do":
            node.due = True
        else:
            self.over(node, node.outcome)

    def pause_node(self, node: _Node) -> None:
        if node.state != "R":
            return
        node.paused = True
        if self.just_begun(node) and (node.kind == "Do" or node.attempt > 1):
            self.not_begun(node)
        if node.inner is not None:
            node.inner.pause()
            still = node.inner.state == "P"
        else:
            still = node.kind != "Insist" or not node.begun
        if node.state == "R":
            self.tell(node, "P" if still else "Q")

    def just_begun(self, node: _Node) -> bool:
        """Whether its action had no time to begin."""
        if not node.begun or node.kind in self.world.graphs or node.begun_at[0] != self.world.now:
            return False
        if node.begun_at != self.world.moment:
            raise TieError
        return True

    def not_begun(self, node: _Node) -> None:
        """It was told something before its action could begin."""
        node.begun, node.number = False, node.number + 1
        self.world.begun[f"{self.name}/{node.name}"] -= 1

    def go_on(self, node: _Node) -> None:
        node.paused = False
        if node.inner is not None:
            node.inner.resume()
        if node.state in "PQ":
            self.tell(node, "R")
        if not node.begun:
            node.begun_at = self.world.moment
            self.begin(node, node.number)
        elif node.due:
            node.due = False
            self.later(node, node.lag, self.come_to_end)

    def stop_node(self, node: _Node) -> None:
        if node.round is not None and node.between:
            node.round = node.round[0], "s"
        if not node.active or node.state == "S":
            return
        self.tell(node, "S")
        node.paused = False
        if node.inner is not None:
            node.inner.stop()
            return
        if self.just_begun(node):
            self.not_begun(node)
        if not node.begun:
            self.world.at_once(self.over, node, "s")
        else:
            self.later(node, node.lag, self.over, "s")
            self.later(node, STOP_TICKS, self.stop_timed_out)

    def stop_timed_out(self, node: _Node) -> None:
        if node.state == "S":
            self.stop_failed = True
            self.ended(node, "E", "e")

    def over(self, node: _Node, outcome: str) -> None:
        """Its action has ended (10.3)."""
        node.going_on = False
        if not node.active:
            return  # given up before
        stopped = node.state == "S"
        failed = outcome in "exn" and not stopped
        if stopped and node.restart and self.state in "RP":
            self.tell(node, "F", "s")
            if self.pausing or self.state == "P":
                self.held.append((node, "again"))
                self.settle()
            else:
                self.run(node)
        elif failed and outcome != "n" and node.attempt <= node.retries and self.state in "RP":
            hold = node.state in "PQ" or self.pausing
            self.run(node, node.attempt + 1)
            if hold:
                self.pause_node(node)
                self.settle()
        elif failed and node.inner is None:
            self.ended(node, "E", "e")
        else:
            self.ended(node, "F", "s" if stopped else "e" if failed else outcome)

    def ended(self, node: _Node, state: str, result: str) -> None:
        stood = node.state in "PQ"
        self.tell(node, state, result)
        if stood:
            self.held.append((node, result))
        else:
            self.follow(node, result)
        self.next_rounds(node)
        self.settle()

    # -- what follows (10.4, 10.7) --------------------------------------------------------------------------

    def follow(self, node: _Node, result: str) -> None:
        if self.pausing or self.state == "P":
            self.held.append((node, result))
        elif self.state == "R" and node.spontaneous:
            others = [other for other in self.reachable(node) if other.active or other.between]
            for other in others:
                self.stop_node(other)
            node.round = {other.name for other in others}, result
            self.next_rounds()
        elif self.state == "R":
            self.propagate(node, result)

    def reachable(self, node: _Node) -> list[_Node]:
        found, wave = {node.name}, [node]
        for item in wave:
            for name in item.children:
                if name and name not in found:
                    found.add(name)
                    wave.append(self.nodes[name])
        return wave[1:]

    def next_rounds(self, over: _Node | None = None) -> None:
        """Go on with spontaneous nodes that waited for others, of which one is over now."""
        for node in self.nodes.values():
            if node.round is not None and over is not None:
                node.round[0].discard(over.name)
        ready = [node for node in self.nodes.values() if node.round is not None and not node.round[0]]
        if len(ready) > 1:
            raise TieError
        for node in ready:
            assert node.round is not None
            result, held = node.round[1], node.round_held
            node.round, node.round_held = None, False
            if self.pausing or self.state == "P" or held:
                self.held.append((node, result))
            elif self.state == "R":
                self.propagate(node, result)
                if self.state == "R" and result in "tf":
                    self.run(node)
            self.next_rounds(node)

    def propagate(self, source: _Node, result: str) -> None:
        wave, passed = [source], set()
        for parent in wave:
            for name in parent.children:
                if (parent.name, name) in passed:
                    continue
                passed.add((parent.name, name))
                if self.reaches(source, parent, name, result, wave):
                    self.become("F", result)
                    for node in self.active():
                        if node.spontaneous:
                            self.stop_node(node)
                    return

    def reaches(self, source: _Node, parent: _Node, name: str, result: str, wave: list[_Node]) -> bool:
        """One edge is seen; whether that ends the graph."""
        if not name:
            self.exit_seen.add(parent.name)
            response = self.exit[parent.name][1][_RESULTS[result]]
            waits = any(needed and item not in self.exit_seen for item, (needed, _) in self.exit.items())
            return response == "bypass" or (response != "ignore" and not waits)
        child = self.nodes[name]
        child.seen.add(parent.name)
        response = child.parents[parent.name][1][_RESULTS[result]]
        if response == "bypass":
            self.tell(child, "b", result)
            wave.append(child)
        elif response != "ignore" and child.ready:
            self.respond(child, response, itself=child is source)
        return False

    def respond(self, child: _Node, response: str, *, itself: bool) -> None:
        if response == "run" and not (itself and child.state != "E"):
            self.run(child)
        elif response == "stop":
            self.stop_node(child)
        elif response == "pause":
            child.round_held = child.between
            self.pause_node(child)
        elif response == "restart" and not child.between:  # which runs again anyway
            child.restart = child.active
            self.stop_node(child)
            self.run(child)

    # -- the graph (8.2, 10.5) ------------------------------------------------------------------------------

    def become(self, state: str, result: str = "") -> None:
        self.state, self.result = state, result
        if not self.replaced:
            self.told[""] += state + result
        if self.outer is None:
            return
        outer, node = self.outer
        if node.inner is not self or not node.active:
            return
        if state in _ENDED or state == "H":
            self.world.at_once(self.tell_end, outer, node)
        elif state == "P" and node.state in "RQ":
            outer.tell(node, "P")
            outer.settle()
        elif state == "R" and node.state in "PQ":
            outer.tell(node, "R")

    def tell_end(self, outer: _Run, node: _Node) -> None:
        if self.state == "E" and node.state == "S":
            outer.stop_timed_out(node)
        outer.over(node, self.result if self.result in "tfse" else "e")

    def settle(self) -> None:
        if not self.begun:
            return
        active = self.active()
        if self.state == "R" and (self.pausing or (self.held and not active)):
            if not any(node.state in "RQ" for node in active):
                self.become("P")
        elif active:
            return
        elif self.state == "S":
            self.become(*("Ee" if self.stop_failed else "Ts"))
        elif self.state == "R":
            self.become("H", "h")
