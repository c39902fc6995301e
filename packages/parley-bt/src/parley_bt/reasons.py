"""Why a graph or a tree cannot be converted: the closed list, held to `README.md` by a test."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType
from typing import Final

from parley.errors import Problem

__all__ = ["EXPORT_REASONS", "IMPORT_REASONS", "refusal"]

EXPORT_REASONS: Final[Mapping[str, str]] = MappingProxyType(
    {
        "broken_graph": "a relation leads nowhere or is stated on one side, or two actions have one name",
        "control_response": "a condition answers with `stop`, `pause` or `restart`",
        "stopped_response": "a condition answers `on_stopped` with anything but `ignore`",
        "spontaneous": "a spontaneous action runs until it is stopped",
        "limits": "an action has a retry count or a time limit of its own",
        "several_actors": "actions of more than one actor stand in one graph",
        "three_ways": "true, false and error lead to three different places",
        "entry_waits": "an action is an entry and also requires a parent",
        "self_edge": "an edge leads from an action back to itself",
        "join_in_cycle": "a join of required parents lies on a cycle",
        "join_never": "a join requires a parent that does not always end before",
        "join_order": "one end of an action reaches a join by several edges with different answers",
        "join_error": "the failure of one of several branches leads somewhere else than to the graph's end",
        "ends_while_running": "the exit is reached while other branches go on",
        "unreachable_node": "no way leads from the entry to an action",
        "unstructured": "what follows what cannot be nested into sequences, fallbacks, parallels and retries",
        "too_deep": "the tree would be nested deeper than 256 levels",
        "node_name": "an action's name cannot be the name of a tree node",
        "port_name": "a parameter's name cannot be the name of a port",
        "value_form": "a value cannot be written as a port's text",
        "several_givers": "an input gets its value from several parents",
        "value_and_giver": "an input has a value of its own and also gets one from a parent",
        "allowed_values": "an input that gets its value from a parent has allowed values",
    }
)
"""Why a graph has no tree."""

IMPORT_REASONS: Final[Mapping[str, str]] = MappingProxyType(
    {
        "malformed_xml": "the text is not well-formed XML",
        "doctype": "the text has a document type or entities of its own",
        "too_large": "more than 1 MB of text, 100 levels, 4000 elements or 1000 actions",
        "not_a_tree_file": "the file is not a BTCPP_format 4 file with exactly one tree to run",
        "unsupported_element": "an element other than those of the subset",
        "unsupported_attribute": "a script, precondition or other attribute outside of the subset",
        "wrong_children": "an element has too few or too many children",
        "bad_number": "a number of attempts or a threshold is none that the subset has",
        "unknown_port": "a port that TreeNodesModel does not declare, or declares as both input and output",
        "value_form": "a port's text is not a value of its type",
        "entry_without_giver": "an entry is read that no action written before gives",
        "entry_passes_by": "an entry is read by an action that does not directly follow its only giver",
        "equal_names": "an output reaches the next action's input of that name, which the tree does not want",
        "join_error": "a branch of a parallel fails while something else than the end of the tree follows",
        "join_in_cycle": "something follows a parallel inside of a retry",
        "join_mixed": "an action follows a parallel and something else as well",
        "branch_ends": "a branch of a parallel that something follows can succeed in several places",
        "never_runs": "an action can never run: what stands before it goes on for ever or always succeeds",
        "end_result": "the tree's result is not the one of the action that ran last",
    }
)
"""Why a tree has no graph."""


def refusal(code: str, path: str, what: str = "", remedy: str = "") -> Problem:
    """A problem with a documented code.

    Args:
        code: A key of `EXPORT_REASONS` or `IMPORT_REASONS`.
        path: Where, in the graph (``actions[3]``) or in the XML (``line 12``).
        what: Which action, element or value it is about.
        remedy: What to do instead, if there is something.
    """
    reason = EXPORT_REASONS.get(code) or IMPORT_REASONS[code]
    return Problem(path, f"{what}: {reason}" if what else reason, remedy, code)
