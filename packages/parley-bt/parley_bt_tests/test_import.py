"""BehaviorTree.CPP trees as graphs: what they become, and each reason why one cannot be imported."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from parley.errors import GraphRefusedError
from parley.umrf.io import read_graph, write_graph
from parley.umrf.model import Graph, NodeRef, Response, Result
from parley_bt import IMPORT_REASONS, export_tree, import_tree
from parley_bt.structure import structure

MODELS = """
  <TreeNodesModel>
    <Action ID="Find">
      <input_port name="what" type="std::string"/>
      <output_port name="pose__x" type="double"/>
      <output_port name="seen" type="bool">Whether</output_port>
    </Action>
    <Action ID="Go"><input_port name="pose__x" type="double"/><input_port name="far" type="double"/></Action>
  </TreeNodesModel>"""


def tree(body: str, models: str = MODELS) -> str:
    return f'<root BTCPP_format="4">\n<BehaviorTree ID="T">\n{body}\n</BehaviorTree>{models}\n</root>'


def edges(graph: Graph) -> dict[tuple[str, str], str]:
    """Answers to true, false and error by edge."""
    results = (Result.ON_TRUE, Result.ON_FALSE, Result.ON_ERROR)
    return {
        (relation.node.full_name, node.full_name): " ".join(relation.response(item).value for item in results)
        for node in graph.nodes
        for relation in node.parents
    }


def test_a_sequence_becomes_a_chain() -> None:
    graph = import_tree(tree("<Sequence><A/><B/></Sequence>"))
    assert edges(graph) == {("A_0", "B_0"): "run bypass bypass"}
    assert [relation.node.full_name for relation in graph.entry] == ["A_0"]
    assert [relation.node.full_name for relation in graph.exit] == ["B_0"]


def test_a_fallback_runs_the_next_after_a_failure() -> None:
    graph = import_tree(tree("<Fallback><A/><B/></Fallback>"))
    assert edges(graph) == {("A_0", "B_0"): "ignore run run"}


def test_a_parallel_becomes_branches_and_what_follows_a_join() -> None:
    graph = import_tree(tree('<Sequence><Parallel success_count="2"><A/><B/></Parallel><C/></Sequence>'))
    assert [relation.node.full_name for relation in graph.entry] == ["A_0", "B_0"]
    joined = graph.node("C_0")
    assert joined is not None
    assert [(relation.node.full_name, relation.required) for relation in joined.parents] == [
        ("A_0", True),
        ("B_0", True),
    ]


def test_a_retry_is_written_out_once_per_attempt() -> None:
    graph = import_tree(tree('<RetryUntilSuccessful num_attempts="3"><A/></RetryUntilSuccessful>'))
    assert edges(graph) == {("A_0", "A_1"): "ignore run run", ("A_1", "A_2"): "ignore run run"}


def test_a_retry_without_end_takes_turns_because_no_action_can_follow_itself() -> None:
    graph = import_tree(tree('<RetryUntilSuccessful num_attempts="-1"><A/></RetryUntilSuccessful>'))
    assert edges(graph) == {("A_0", "A_1"): "ignore run run", ("A_1", "A_0"): "ignore run run"}


def test_values_and_entries_become_parameters_and_transfers() -> None:
    find_it = '<Find what="a box" pose__x="{goal}" name="Find_7"/>'
    graph = import_tree(tree(f'<Sequence>{find_it}<Go pose__x="{{goal}}" far="2"/></Sequence>'))
    find, go = graph.nodes
    assert find.ref == NodeRef("Find", 7)
    assert find.input_parameters["what"].value == "a box"
    assert find.output_parameters["seen"].type == "bool"
    assert go.input_parameters["far"].value == 2.0
    assert go.input_parameters["pose::x"].value is None
    assert find.children[0].remap == ()


def test_an_entry_between_different_names_becomes_a_rename() -> None:
    models = MODELS.replace('<input_port name="pose__x" type="double"/>', "")
    body = '<Sequence><Find what="a" pose__x="{d}"/><Go far="{d}"/></Sequence>'
    graph = import_tree(tree(body, models))
    assert graph.nodes[0].children[0].remap == (("pose::x", "far"),)


def test_an_action_says_what_its_false_means() -> None:
    graph = import_tree(tree('<Sequence><A on_false="SUCCESS"/><B/></Sequence>'))
    assert edges(graph) == {("A_0", "B_0"): "run run bypass"}


def test_a_decorated_action_can_be_left_out() -> None:
    left_out = "<Fallback><Inverter><A/></Inverter><B/></Fallback>"
    graph = import_tree(tree(f"<Sequence>{left_out}<ForceSuccess><C/></ForceSuccess><D/></Sequence>"))
    assert export_tree(graph).count("Inverter") == 2
    assert import_tree(export_tree(graph)) == graph


def test_what_is_imported_is_a_graph_file() -> None:
    graph = import_tree(tree("<Sequence><A/><Fallback><B/><C/></Fallback></Sequence>"))
    assert read_graph(write_graph(graph, faithful=True)) == graph
    assert {relation.response(Result.ON_STOPPED) for node in graph.nodes for relation in node.parents} == {
        Response.IGNORE
    }


def test_comments_processing_instructions_and_text_say_nothing() -> None:
    plain = import_tree(tree("<Sequence><A/><B/></Sequence>"))
    busy = tree("<Sequence>some <!-- words --><A/><?x y?>text<B/></Sequence>")
    assert structure(import_tree(f'<?xml version="1.0"?>{busy}')) == structure(plain)


BOMB = '<!DOCTYPE r [<!ENTITY a "aaaa"><!ENTITY b "&a;&a;">]>' + tree("<A/>")
ENOUGH = '<RetryUntilSuccessful num_attempts="100">'
TWO = "<Parallel><A/><B/></Parallel>"

REFUSED: list[tuple[str, str, str]] = [
    ("malformed_xml", "<root", "line 1"),
    ("malformed_xml", tree("<A name='&unknown;'/>"), "line 3"),
    ("doctype", BOMB, "line 1"),
    ("doctype", "<!DOCTYPE root SYSTEM 'file:///etc/hostname'>" + tree("<A/>"), "line 1"),
    ("too_large", tree("<A/>" + " " * 1_000_000), ""),
    ("too_large", tree("<Inverter>" * 101 + "<A/>" + "</Inverter>" * 101), "line 3, <Inverter>"),
    ("too_large", tree("<Sequence>" + "<A/>" * 1001 + "</Sequence>"), "line 2, <BehaviorTree>"),
    ("too_large", tree(ENOUGH * 3 + "<A/>" + "</RetryUntilSuccessful>" * 3),
     "line 2, <BehaviorTree>"),
    ("too_large", tree(ENOUGH * 9 + "<Sequence/>" + "</RetryUntilSuccessful>" * 9), "line 2, <BehaviorTree>"),
    ("not_a_tree_file", "<root><BehaviorTree ID='T'><A/></BehaviorTree></root>", "line 1, <root>"),
    ("not_a_tree_file", '<root BTCPP_format="4"/>', "line 1, <root>"),
    ("unsupported_element", tree("<ReactiveSequence><A/></ReactiveSequence>"), "line 3, <ReactiveSequence>"),
    ("unsupported_element", tree('<SubTree ID="U"/>'), "line 3, <SubTree>"),
    ("unsupported_element",
     '<root BTCPP_format="4"><include path="x"/><BehaviorTree><A/></BehaviorTree></root>',
     "line 1, <include>"),
    ("unsupported_attribute", tree('<Sequence _skipIf="true"><A/></Sequence>'), "line 3, <Sequence>"),
    ("unsupported_attribute", tree('<A _onSuccess="x:=1"/>'), "line 3, <A>"),
    ("wrong_children", tree("<Sequence/>"), "line 3, <Sequence>"),
    ("wrong_children", tree("<Inverter><A/><B/></Inverter>"), "line 3, <Inverter>"),
    ("wrong_children", tree("<A><B/></A>"), "line 3, <A>"),
    ("bad_number", tree('<RetryUntilSuccessful num_attempts="0"><A/></RetryUntilSuccessful>'),
     "line 3, <RetryUntilSuccessful>"),
    ("bad_number", tree('<RetryUntilSuccessful num_attempts="{n}"><A/></RetryUntilSuccessful>'),
     "line 3, <RetryUntilSuccessful>"),
    ("bad_number", tree('<Parallel success_count="1"><A/><B/></Parallel>'), "line 3, <Parallel>"),
    ("unknown_port", tree('<A speed="1"/>'), "line 3, <A>"),
    ("unknown_port",
     tree("<A/>", '<TreeNodesModel><Action ID="A"><inout_port name="p"/></Action></TreeNodesModel>'),
     "line 4, <inout_port>"),
    ("value_form", tree('<Go far="much"/>'), "line 3, <Go>"),
    ("value_form", tree('<Go far="nan"/>'), "line 3, <Go>"),
    ("value_form", tree('<A on_false="RUNNING"/>'), "line 3, <A>"),
    ("entry_without_giver", tree('<Go pose__x="{goal}"/>'), "line 3, <Go>"),
    ("entry_passes_by", tree('<Sequence><Find pose__x="{g}"/><A/><Go pose__x="{g}"/></Sequence>'),
     "line 3, <Go>"),
    ("equal_names", tree('<Sequence><Find/><Go pose__x="1"/></Sequence>'), "line 3, <Go>"),
    ("join_error", tree(f"<Fallback>{TWO}<C/></Fallback>"), "line 3, <A>"),
    ("join_error", tree('<Sequence><ParallelAll><A/><B/></ParallelAll><C/></Sequence>'),
     "line 3, <A>"),
    ("join_in_cycle", tree(f'<RetryUntilSuccessful num_attempts="-1">{TWO}</RetryUntilSuccessful>'),
     "line 3, <A>"),
    ("join_mixed", tree(f"<Sequence><Fallback><X/>{TWO}</Fallback><C/></Sequence>"), "line 3, <C>"),
    ("branch_ends", tree("<Sequence><Parallel><Fallback><A/><B/></Fallback><C/></Parallel><D/></Sequence>"),
     "line 3, <A>"),
    ("never_runs", tree("<Fallback><ForceSuccess><A/></ForceSuccess><B/></Fallback>"), "line 3, <B>"),
    ("end_result", tree("<ForceSuccess><A/></ForceSuccess>"), "line 3, <A>"),
]  # fmt: skip


@pytest.mark.parametrize(
    ("code", "text", "path"), REFUSED, ids=[f"{code}-{path}" for code, _, path in REFUSED]
)
def test_a_tree_without_a_graph_is_refused_with_reason_line_and_element(
    code: str, text: str, path: str
) -> None:
    with pytest.raises(GraphRefusedError) as refused:
        import_tree(text)
    assert (code, path) in [(problem.code, problem.path) for problem in refused.value.problems]


def test_every_reason_has_an_example() -> None:
    assert {code for code, _, _ in REFUSED} == IMPORT_REASONS.keys()


@given(st.text(max_size=200) | st.text("<>/ABroot\"'= &;!?-[]", max_size=200))
def test_whatever_is_read_it_is_a_refusal_and_nothing_else(text: str) -> None:
    with pytest.raises(GraphRefusedError):
        import_tree(text)


@given(st.text(max_size=60))
def test_whatever_stands_in_a_tree_is_read_or_refused(text: str) -> None:
    try:
        import_tree(tree(text))
        import_tree(tree(f"<Find what='{text}'/>"))
    except GraphRefusedError as error:
        assert {problem.code for problem in error.problems} <= IMPORT_REASONS.keys()
