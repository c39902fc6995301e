"""One full example of every payload, as JSON: what the tests of the wire start from."""

from __future__ import annotations

from typing import Any

from pydantic import BaseModel

from parley.messages import chat, display, failure, memory, status

MOVE: dict[str, Any] = {
    "Move": {
        "input_parameters": {
            "pose": {"position": {"x": {"pvf_type": "number", "pvf_value": 1.5}}},
            "way": {"pvf_type": "strings", "pvf_value": ["quick", "quiet"]},
        },
        "output_parameters": {"arrived": {"pvf_type": "bool"}},
        "reason": "to fetch the box",
        "flow": {"if": {"step": 0, "result": False}, "together_with": 1, "repeat": 3},
    }
}
LOOK: dict[str, Any] = {"Look": {"input_parameters": {}, "output_parameters": {}}}

POSE = {"x": 1.0, "y": -2.5, "yaw": 3.1}
MEMORY = {
    "type": "text",
    "data": "The box is by the door.",
    "info": "the box",
    "scope": "A",
    "source": "operator",
}
ACTION_INFO: dict[str, Any] = {
    "name": "Move",
    "inputs": {"pose::position::x": "number"},
    "optional": ["way"],
    "outputs": {"arrived": "bool"},
    "description": "Go there.",
    "phrases": ["go to {place}"],
    "effects": ["moves"],
    "risk": "high",
    "capabilities": ["drive"],
    "examples": ["move to the box"],
    "duration_s": 5.0,
    "timeout_s": 60.0,
}

SAMPLES: dict[type[BaseModel], dict[str, Any]] = {
    chat.ChatInput: {"message": "go", "targets": ["A"], "type": "response", "id": "1", "reply_to": "q"},
    chat.ChatFeedback: {
        "message": "Which one?",
        "targets": ["A"],
        "type": "request",
        "sources": ["box"],
        "choices": ["this", "that"],
        "id": "q",
        "closes": "p",
    },
    chat.FlowIf: {"step": 2, "result": False},
    chat.Flow: {"if": {"step": 2, "result": True}, "together_with": 1, "repeat": 2},
    chat.ActionCall: MOVE,
    chat.SystemCommand: {"pop": {"parameters": 1}},
    chat.ChatAction: {
        "message_response": "I go.",
        "queue": [LOOK, MOVE],
        "system_cmd": [{"stop": {}}, {"add_memory": {"data": "d", "info": "i"}}],
        "targets": ["A", "B"],
        "success": True,
        "choices": ["yes"],
        "sources": ["box"],
    },
    display.RawImage: {"data": [1, 2, 3], "height": 1, "width": 1, "encoding": "rgb8", "step": 3},
    display.DisplayFeed: {"target": "A", "name": "camera", "image": "aGk=", "info": {"k": [1]}},
    failure.FailureReport: {
        "message": "No way.",
        "process_instrutions": "ask",
        "process_data_text": "text",
        "process_data_images": ["aGk="],
        "code": "ambiguous",
        "details": {"candidates": [{"id": "box_1"}]},
    },
    failure.ErrorHandlingMessage: {
        "error_message": "No way.",
        "action_called": MOVE,
        "umrf_queue": [LOOK],
        "target": "A",
        "process_instrutions": "ask",
        "process_data_text": "text",
        "process_data_images": ["aGk="],
        "code": "unreachable",
        "details": {"distance_m": 1.5},
        "completed": [LOOK],
        "failure_id": "g/Move_0",
    },
    memory.MemoryBody: MEMORY,
    memory.MemoryEntry: {**MEMORY, "name": "box", "created_unix_ms": 1, "updated_unix_ms": 2},
    memory.AddToMemory: {
        "box": MEMORY,
        "door": {"type": "image", "data": "aGk=", "info": "", "scope": "", "source": ""},
    },
    memory.RemoveMemory: {"box": {}, "door": None},
    memory.GetMemory: {"request": "where is the box?", "scope": "A"},
    memory.MemoryReply: {"box": MEMORY},
    memory.MemoryEvent: {"kind": "failed", "name": "box", "message": "The disk is full."},
    status.PoseInfo: POSE,
    status.ActionInfo: ACTION_INFO,
    status.ActorStatus: {
        "actor": "A",
        "state": "running",
        "sequence": 3,
        "pose": POSE,
        "at_rest": False,
        "graphs": {"g": "RUNNING"},
        "catalogue": [ACTION_INFO],
        "map_name": "hall",
    },
    status.GraphEvent: {
        "actor": "A",
        "graph_name": "g",
        "sequence": 0,
        "kind": "node",
        "state": "FINISHED",
        "node": "Move_0",
        "instance_id": 0,
        "cause": "edge",
        "result": "on_true",
        "outputs": {"arrived": {"pvf_type": "bool", "pvf_value": True}},
        "message": "done",
        "progress": 0.5,
        "progress_text": "halfway",
        "robot_time_s": 12.25,
        "unix_ms": 1,
    },
    status.PlanStep: {"action": MOVE, "node": "Move_0", "state": "running"},
    status.PlanUpdate: {
        "kind": "update",
        "target": "A",
        "graph_name": "g",
        "state": "paused",
        "steps": [{"action": MOVE, "node": "Move_0", "state": "paused"}],
    },
    status.PlanProposal: {"kind": "proposal", "id": "1", "target": "A", "message": "So?", "steps": [MOVE]},
    status.PlanDecision: {
        "id": "1",
        "target": "A",
        "decision": "edit",
        "steps": [MOVE],
        "policy": "ask_first",
    },
    status.StepCommand: {"target": "A", "graph_name": "g", "node": "Move_0", "command": "end"},
    status.StopCommand: {"command": "reset", "targets": ["A"], "id": "1"},
    status.StopReport: {"actor": "A", "id": "1", "state": "at_rest"},
    status.SyncNotice: {
        "kind": "ended",
        "actor": "A",
        "graph_name": "g",
        "id": "1",
        "node": "Move_0",
        "result": "on_true",
        "outputs": {"x": {"pvf_type": "number", "pvf_value": 1.0}},
        "answers": "2",
        "message": "it did not work",
        "command": "modify",
        "targets": ["A", "B"],
        "graph_json": "{}",
        "continue_from": "Move_1",
    },
    status.RejectionProblem: {"path": "x", "message": "wrong", "remedy": "right it", "code": "bad"},
    status.Rejection: {
        "source": "A",
        "target": "B",
        "what": "umrf_graph_start",
        "graph_name": "g",
        "problems": [{"path": "x", "message": "wrong", "remedy": "right it", "code": "bad"}],
        "detail": {"k": {"v": [1]}},
    },
}
