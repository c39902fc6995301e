"""What ROS types consist of: read from `.msg`, `.srv` and `.action` files, and the hash that names each.

The hash (RIHS01) is computed, not looked up, so that a type of somebody's own has the right one too.
"""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any, Final

from rosbags.interfaces import Nodetype
from rosbags.typesys import get_types_from_msg
from rosbags.typesys.store import Typestore

from parley.errors import FileFormatError, UnsupportedError

__all__ = ["Definitions", "of_release"]

OWN: Final = Path(__file__).parent / "interfaces"

RELEASES: Final = Path(__file__).parent / "releases"

Fields = list[tuple[str, Any]]
"""Names, and descriptions as the library has them."""

UUID: Final = (Nodetype.NAME, "unique_identifier_msgs/msg/UUID")
TIME: Final = (Nodetype.NAME, "builtin_interfaces/msg/Time")
EVENT_INFO: Final = (Nodetype.NAME, "service_msgs/msg/ServiceEventInfo")


def of_release(name: str) -> Path:
    """The folder with what a release of ROS defines otherwise than Jazzy; there is none for those like it."""
    return RELEASES / name


class Definitions:
    """Types by their ROS names, those derived from services and actions as well; read when first asked for.

    Args:
        folders: Where others than our own are: `<package>/msg/<Name>.msg`, as in a ROS installation.
    """

    def __init__(self, *folders: Path) -> None:
        self._folders = (*folders, OWN)
        self._hashes: dict[str, str] = {}
        self.store = Typestore()
        """What reads and writes the bytes of all types asked for so far."""

    def fields(self, ros_type: str) -> Fields:
        """The fields of a type, in their order.

        Raises:
            UnsupportedError: Its definition is not there.
            FileFormatError: Its definition cannot be read.
        """
        if ros_type not in self.store.fielddefs:
            self._load(ros_type)
        if ros_type not in self.store.fielddefs:
            raise UnsupportedError(f"there is no type {ros_type}")
        return self.store.fielddefs[ros_type][1]

    def hash(self, ros_type: str) -> str:
        """`RIHS01_...`, as every ROS 2 since Iron computes it."""
        if ros_type not in self._hashes:
            self.fields(ros_type)
            self._hashes[ros_type] = self.store.hash_rihs01(ros_type)
        return self._hashes[ros_type]

    def _load(self, ros_type: str) -> None:
        package, _, rest = ros_type.partition("/")
        kind, _, name = rest.partition("/")
        file = Path(package) / kind / f"{name.partition('_')[0]}.{kind}"
        found = next((folder / file for folder in self._folders if (folder / file).is_file()), None)
        if found is None:
            raise UnsupportedError(
                f"the definition of {ros_type} is missing; put {file.as_posix()} into a folder of definitions"
            )
        base = f"{package}/{kind}/{file.stem}"
        parts = _SEPARATOR.split(found.read_text(encoding="utf-8"))
        if len(parts) != {"msg": 1, "srv": 2, "action": 3}.get(kind):
            raise FileFormatError(str(found), "", "services have one line ---, actions two, messages none")
        derived: dict[str, Fields] = {}
        for suffix, text in zip(_SUFFIXES[kind], parts, strict=True):
            derived[base + suffix] = _read(found, package, text)
        if kind == "srv":
            derived |= _service(base)
        elif kind == "action":
            derived |= _action(base)
        self.store.register({name: ([], fields) for name, fields in derived.items()})
        for fields in derived.values():
            for _, description in fields:
                nested = description if description[0] <= Nodetype.NAME else description[1][0]
                if nested[0] == Nodetype.NAME:
                    self.fields(nested[1])


_SEPARATOR: Final = re.compile(r"^---[ \t]*$", re.MULTILINE)
_SUFFIXES: Final = {
    "msg": ("",),
    "srv": ("_Request", "_Response"),
    "action": ("_Goal", "_Result", "_Feedback"),
}


def _read(file: Path, package: str, text: str) -> Fields:
    try:
        ((_, fields),) = get_types_from_msg(text, f"{package}/msg/Unnamed").values()
    except Exception as error:  # the library's parser has errors of many kinds
        raise FileFormatError(str(file), "", f"it cannot be read: {error}") from error
    return [(name, _byte_wide(description)) for name, description in fields] or [_EMPTY]


_EMPTY: Final = ("structure_needs_at_least_one_member", (Nodetype.BASE, ("uint8", 0)))
"""A type without fields has one all the same."""


def _byte_wide(description: Any) -> Any:
    """ROS 2 takes `char` for `uint8`, in the hash too; the library does not."""
    kind, inner = description
    if kind == Nodetype.BASE:
        return (kind, ("uint8", 0)) if inner[0] == "char" else description
    if kind == Nodetype.NAME:
        return description
    return (kind, (_byte_wide(inner[0]), inner[1]))


def _service(base: str) -> dict[str, Fields]:
    request, response = (Nodetype.NAME, f"{base}_Request"), (Nodetype.NAME, f"{base}_Response")
    return {
        f"{base}_Event": [
            ("info", EVENT_INFO),
            ("request", (Nodetype.SEQUENCE, (request, 1))),
            ("response", (Nodetype.SEQUENCE, (response, 1))),
        ],
        base: [
            ("request_message", request),
            ("response_message", response),
            ("event_message", (Nodetype.NAME, f"{base}_Event")),
        ],
    }


def _action(base: str) -> dict[str, Fields]:
    def own(suffix: str) -> tuple[Nodetype, str]:
        return (Nodetype.NAME, base + suffix)

    return {
        f"{base}_SendGoal_Request": [("goal_id", UUID), ("goal", own("_Goal"))],
        f"{base}_SendGoal_Response": [("accepted", (Nodetype.BASE, ("bool", 0))), ("stamp", TIME)],
        **_service(f"{base}_SendGoal"),
        f"{base}_GetResult_Request": [("goal_id", UUID)],
        f"{base}_GetResult_Response": [("status", (Nodetype.BASE, ("int8", 0))), ("result", own("_Result"))],
        **_service(f"{base}_GetResult"),
        f"{base}_FeedbackMessage": [("goal_id", UUID), ("feedback", own("_Feedback"))],
        base: [
            ("goal", own("_Goal")),
            ("result", own("_Result")),
            ("feedback", own("_Feedback")),
            ("send_goal_service", own("_SendGoal")),
            ("get_result_service", own("_GetResult")),
            ("feedback_message", own("_FeedbackMessage")),
        ],
    }
