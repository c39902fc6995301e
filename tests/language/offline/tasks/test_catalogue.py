"""Actions never seen before are used by what their catalogue says."""

from __future__ import annotations

import pytest

from parley.language.offline.tasks.catalogue import Catalogue, roles_of
from parley.messages.status import ActionInfo
from tests.language.dev_set import CATALOGUES


@pytest.mark.parametrize(
    ("info", "roles"),
    [
        (ActionInfo(name="NavigateTo", inputs={"x": "number", "y": "number"}), {"motion"}),
        (ActionInfo(name="drive_to", inputs={"goal": "string"}), {"motion"}),
        (
            ActionInfo(name="FindPose", inputs={"of": "string"}, outputs={"x": "number", "y": "number"}),
            {"locate"},
        ),
        (ActionInfo(name="look_for_obj", inputs={"object": "string"}), {"search"}),
        (ActionInfo(name="pass_to", inputs={"person": "string"}), {"handover"}),
        (ActionInfo(name="Zorp", effects=("looks",)), {"look"}),
        (ActionInfo(name="Zorp", phrases=("drive to {where}",), inputs={"where": "string"}), {"motion"}),
        (ActionInfo(name="Zorp", description="Grasp an object."), {"grasp"}),
        (ActionInfo(name="Zorp", description="Something nobody knows."), set()),
    ],
)
def test_what_an_action_is_good_for(info: ActionInfo, roles: set[str]) -> None:
    assert roles_of(info) == roles


def test_numbers_are_chained_to_the_action_that_provides_them() -> None:
    catalogue = Catalogue(CATALOGUES["location"])
    mover = catalogue.mover
    assert mover is not None
    steps = catalogue.chain(mover, {}, "door", "go")
    assert steps is not None
    assert [step.name for step in steps] == ["GetCoordinates", "NavigateTo"]
    assert steps[0].input_parameters["location"].value == "door"
    assert all(not p.has_data and p.type == "number" for p in steps[1].input_parameters.values())
    assert set(steps[0].output_parameters) == set(steps[1].input_parameters)


def test_without_a_provider_there_is_no_chain() -> None:
    info = ActionInfo(name="NavigateTo", inputs={"x": "number", "y": "number"})
    alone = Catalogue([info])
    assert alone.chain(info, {}, "door", "go") is None
    assert Catalogue([ActionInfo(name="NavigateTo", inputs={"speed": "number"})]).mover is None
