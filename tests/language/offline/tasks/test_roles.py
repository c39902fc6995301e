"""What an action is good for, by its name and inputs."""

import pytest

from parley.language.offline.tasks.catalogue import Catalogue
from parley.language.offline.tasks.roles import pose_inputs, roles_of
from parley.messages.status import ActionInfo


@pytest.mark.parametrize(
    ("name", "inputs", "role"),
    [
        ("nav2_go", {"loc": "string"}, {"motion"}),
        ("fly_to_waypoint", {"waypoint": "string"}, {"motion"}),
        ("pickObj", {"obj": "string"}, {"grasp"}),
        ("release_to", {"person": "string"}, {"handover"}),
        ("take_order", {"table": "string"}, set()),
        ("set_language", {"language": "string"}, set()),
        ("land", {}, set()),
        ("homeArm", {}, set()),
        ("charge_now", {}, {"dock"}),
        ("request_crane", {"floor": "integer"}, set()),
        ("request_help", {"message": "string"}, {"ask"}),
        ("return_tray", {"tray": "string"}, set()),
        ("return_to", {"location": "string"}, {"back"}),
        ("warning_lamp", {"on": "bool"}, set()),
        ("warning", {"text": "string"}, {"speak"}),
    ],
)
def test_the_whole_name_decides_what_an_action_is_good_for(
    name: str, inputs: dict[str, str], role: set[str]
) -> None:
    assert roles_of(ActionInfo(name=name, inputs=inputs)) == role


def test_what_is_put_with_a_text_is_no_thing_that_is_put_down() -> None:
    note = ActionInfo(
        name="stick_note", inputs={"crate": "string", "text": "string"}, phrases=("put a note on",)
    )
    assert roles_of(note) == set()
    lay = ActionInfo(name="lay", inputs={"crate": "string"}, phrases=("put it down",))
    assert roles_of(lay) == {"place"}


def test_numbers_for_axes_are_a_place() -> None:
    info = ActionInfo(name="goto_pose", inputs={"x": "float", "y": "float", "theta": "float"})

    assert pose_inputs(info) == {"x": "x", "y": "y", "theta": "yaw"}


def test_fetching_without_goal_is_taking_where_another_action_hands_over() -> None:
    fetch = ActionInfo(name="fetch_item", inputs={"item": "string"})
    give = ActionInfo(name="handover", inputs={"item": "string", "person": "string"})
    move = ActionInfo(name="moveTo", inputs={"location": "string"})

    assert Catalogue((move, fetch, give)).roles(fetch) == {"grasp"}
    assert Catalogue((move, fetch)).roles(fetch) == {"fetch"}
