"""A tree and its graph do the same: whatever ends how, the same actions run in the same order."""

from __future__ import annotations

from itertools import pairwise

from hypothesis import assume, given, settings

from parley.errors import GraphRefusedError
from parley.umrf.model import Graph, Node, Result
from parley_bt import EXPORT_REASONS, IMPORT_REASONS, export_tree, import_tree
from parley_bt.build import Links, build
from parley_bt.shape import Shape, leaves
from parley_bt.structure import structure

from .format_rules import violations
from .graphs import DEFAULT, STRICT, graph, graphs, scripts, shapes
from .scripted import MAX_RUNS, Trace, has_parallel, run, tick


def script_of(graph: Graph, endings: list[str]) -> dict[str, str]:
    return dict(zip([node.full_name for node in graph.nodes], endings, strict=False))


def agree(shape: Shape, tree: Trace, engine: Trace) -> bool:
    """Whether both did the same, as far as it is promised (`README.md`)."""
    if tree.halted_others:  # the others may have got less far
        return engine.result is not Result.ON_TRUE
    if has_parallel(shape):  # nobody promises an order among branches
        return len(tree.runs) > MAX_RUNS or sorted(tree.runs) == sorted(engine.runs)
    return tree.runs == engine.runs


@settings(max_examples=100, deadline=None)
@given(graphs(), scripts)
async def test_an_exported_graph_does_what_its_tree_does(drawn: Graph, endings: list[str]) -> None:
    try:
        shape = structure(drawn)
    except GraphRefusedError as error:
        assert {problem.code for problem in error.problems} <= EXPORT_REASONS.keys()
        return
    script = script_of(drawn, endings)
    tree, engine = tick(shape, script), await run(drawn, script)
    assert agree(shape, tree, engine), (shape, tree, engine)
    one_way_out = len(drawn.exit) == 1 and not has_parallel(shape)
    if one_way_out and engine.result is not None and engine.result is not Result.ON_HALTED:
        assert tree.success is (engine.result is Result.ON_TRUE)


@settings(max_examples=60, deadline=None)
@given(shapes(), scripts)
async def test_an_imported_tree_is_run_as_it_is_written_and_can_be_exported_again(
    shape: Shape, endings: list[str]
) -> None:
    nodes = {leaf.node: Node(leaf.node.name, leaf.node.instance_id) for leaf in leaves(shape)}
    assume(len(nodes) <= len(endings))
    try:
        built = build("g", shape, nodes, Links())
    except GraphRefusedError as error:
        assert {problem.code for problem in error.problems} <= IMPORT_REASONS.keys()
        return
    script = script_of(built, endings)
    tree, engine = tick(shape, script), await run(built, script)
    assert agree(shape, tree, engine), (built, tree, engine)
    again = structure(built)
    assert agree(again, tick(again, script), engine), again
    if engine.result is not None and not has_parallel(shape):
        assert tree.success is (engine.result is Result.ON_TRUE)


@settings(max_examples=50, deadline=None)
@given(graphs(), scripts)
async def test_a_graph_that_goes_out_and_comes_back_does_the_same(drawn: Graph, endings: list[str]) -> None:
    try:
        text = export_tree(drawn)
    except GraphRefusedError:
        return
    assert violations(text) == []
    try:
        back = import_tree(text)
    except GraphRefusedError as error:
        assert {problem.code for problem in error.problems} <= IMPORT_REASONS.keys()
        return
    script = script_of(drawn, endings)
    shape = structure(drawn)
    tree = tick(shape, script)
    assert agree(shape, tree, await run(drawn, script))
    assert agree(shape, tree, await run(back, script))
    assert export_tree(back) == text


async def test_the_comparison_would_notice_a_difference() -> None:
    strict = graph({("A", "B"): STRICT}, leave={"B": STRICT})
    lenient = graph({("A", "B"): DEFAULT}, leave={"B": STRICT})
    script = {"A_0": "F"}
    assert not agree(structure(strict), tick(structure(strict), script), await run(lenient, script))


def test_a_long_chain_is_exported() -> None:
    names = [f"N{index:04}" for index in range(300)]
    long = graph(dict.fromkeys(pairwise(names), DEFAULT), entry=names[:1], leave={names[-1]: DEFAULT})
    assert export_tree(long).count("<Action ID=") == 600
