"""Actions for one kind of thing: what is coupled, narrow looks, doors held, words said at a place."""

from collections.abc import Sequence

import pytest

from parley.language.base import Situation, Turn
from parley.language.offline.interpreter import interpret
from parley.messages.status import ActionInfo
from parley.world.geometry import Pose2D
from parley.world.object_map import MapObject

GO = ActionInfo(name="moveTo", inputs={"place": "string"}, description="Drive to a place.")
THEATRE = (
    GO,
    ActionInfo(name="polish", inputs={"floor": "string"}, description="Polish a floor."),
    ActionInfo(
        name="count_seats",
        inputs={"row": "string"},
        outputs={"count": "number"},
        description="Count the free seats in a row.",
    ),
    ActionInfo(
        name="TestMicrophone", inputs={"microphone": "string"}, description="Test whether a microphone works."
    ),
    ActionInfo(
        name="CheckTrap",
        inputs={"trap": "string"},
        description="See whether a mouse trap has caught something.",
    ),
    ActionInfo(name="attach_cart", inputs={"cart": "string"}, description="Hook a cart to the back."),
    ActionInfo(name="detach_cart", inputs={"cart": "string"}, description="Let go of a cart."),
    ActionInfo(name="pick_item", inputs={"item": "string"}, description="Pick up an item."),
    ActionInfo(
        name="put_into",
        inputs={"item": "string", "container": "string"},
        description="Put an item into a container.",
    ),
    ActionInfo(name="hold_curtain", inputs={"curtain": "string"}, description="Hold a curtain open."),
    ActionInfo(name="announce", inputs={"text": "string"}, description="Say something aloud."),
    ActionInfo(
        name="dim",
        inputs={"row": "string", "percent": "number"},
        phrases=("dim the lamps in {row} to {percent}",),
    ),
    ActionInfo(
        name="measure_warmth",
        inputs={"place": "string"},
        outputs={"degrees": "number"},
        description="Measure the temperature at a place.",
    ),
)
STAGE = (
    MapObject("row_a", "row A", 5.0, 5.0, "row"),
    MapObject("row_c", "row C", 5.0, 9.0, "row"),
    MapObject("foyer", "foyer", 0.0, 3.0, "room"),
    MapObject("stage", "stage", 0.0, 12.0, "stage"),
    MapObject("mic_1", "left microphone", -1.0, 12.0, "microphone"),
    MapObject("mic_2", "right microphone", 1.0, 12.0, "microphone"),
    MapObject("trap_1", "trap 1", 3.0, -3.0, "trap"),
    MapObject("trap_2", "trap 2", 4.0, -3.0, "trap"),
    MapObject("cart_1", "costume cart", 8.0, 8.0, "cart"),
    MapObject("box_a", "container A", -5.0, 2.0, "container"),
    MapObject("curtain", "red curtain", 0.0, 11.0, "curtain"),
)


def _plan(said: str, catalogue: Sequence[ActionInfo] = THEATRE, history: tuple[Turn, ...] = ()) -> list[str]:
    situation = Situation(
        message=said,
        history=history,
        objects=STAGE,
        robot_pose=Pose2D(0.0, 0.0, 0.0),
        robot="Pipo",
        robots=("Pipo",),
        catalogue=tuple(catalogue),
    )
    steps = []
    for step in interpret(situation).queue:
        values = [
            f"{p.value:g}" if isinstance(p.value, float) else str(p.value)
            for p in step.input_parameters.values()
        ]
        hangs = "if " if step.flow is not None and step.flow.if_ is not None else ""
        steps.append(f"{hangs}{step.name} {', '.join(values)}".strip())
    return steps


@pytest.mark.parametrize(
    ("said", "plan"),
    [
        (
            "Bring the costume cart to the stage",
            ["attach_cart costume cart", "moveTo stage", "detach_cart costume cart"],
        ),
        (
            "Take the costume cart to the foyer and detach it",
            ["attach_cart costume cart", "moveTo foyer", "detach_cart costume cart"],
        ),
        (
            "Attach the costume cart, go to the foyer and let go of it",
            ["attach_cart costume cart", "moveTo foyer", "detach_cart costume cart"],
        ),
    ],
)
def test_what_is_coupled_is_brought_so(said: str, plan: list[str]) -> None:
    assert _plan(said) == plan


def test_nothing_else_is_put_down_by_letting_go_of_a_cart() -> None:
    plan = _plan("Pick up the red ball and put it into A")
    assert plan == ["pick_item red ball", "moveTo container A", "put_into red ball, container A"]


@pytest.mark.parametrize(
    ("said", "plan"),
    [
        ("Check both microphones", ["TestMicrophone left microphone", "TestMicrophone right microphone"]),
        ("Is the right microphone working?", ["TestMicrophone right microphone"]),
        ("See if trap 1 has caught anything", ["CheckTrap trap 1"]),
        ("Look at the stage", []),
    ],
)
def test_a_narrow_look_is_at_its_own_kind_only(said: str, plan: list[str]) -> None:
    assert _plan(said) == plan


def test_a_curtain_that_is_held_open_is_not_taken() -> None:
    assert _plan("Can you hold the red curtain open") == ["hold_curtain red curtain"]


def test_the_place_of_an_announcement_is_no_part_of_it() -> None:
    plan = _plan("Announce in the foyer that the play begins at eight")
    assert plan == ["moveTo foyer", "announce the play begins at eight"]
    plan = _plan("Announce that the play in the foyer begins at eight")
    assert plan == ["announce the play in the foyer begins at eight"]


def test_a_phrase_that_fits_the_whole_order_is_not_cut() -> None:
    assert _plan("dim the lamps in row C to 20 percent") == ["dim row C, 20"]


def test_it_is_nothing_where_a_measurement_decides() -> None:
    plan = _plan("hold the red curtain open if it's hotter than 30 degrees at the stage")
    assert plan == ["measure_warmth stage", "if hold_curtain red curtain"]


def test_a_question_and_the_order_to_find_out_are_one() -> None:
    assert _plan("How many seats are left in row C? Count them please.") == ["count_seats row C"]


def test_the_deed_goes_on_with_what_is_done_afterwards() -> None:
    clean = (GO, ActionInfo(name="WipeMicrophone", inputs={"microphone": "string"}))
    plan = _plan("wipe the left microphone, the right microphone afterwards", clean)
    assert plan == ["WipeMicrophone left microphone", "WipeMicrophone right microphone"]


def test_polishing_is_no_sweeping() -> None:
    assert _plan("Sweep the foyer") == []
    assert _plan("Polish the foyer") == ["polish foyer"]


def test_a_number_answers_how_much() -> None:
    dims = (GO, ActionInfo(name="dim_lamps", inputs={"row": "string", "percent": "number"}))
    asked = (Turn("operator", "Dim the lamps in row A."), Turn("assistant", "How far should they go down?"))
    assert _plan("twenty", dims, asked) == ["dim_lamps row A, 20"]


def test_somebody_with_a_title_is_no_robot() -> None:
    serve = (
        GO,
        ActionInfo(
            name="serve", inputs={"dish": "string", "guest": "string"}, phrases=("bring {dish} to {guest}",)
        ),
    )
    assert _plan("Bring the soup to Mrs Pipa", serve) == ["serve soup, Mrs Pipa"]


def test_no_picture_is_taken_of_a_noise() -> None:
    shots = (GO, ActionInfo(name="take_photo", inputs={"target": "string"}, description="Take a picture."))
    assert _plan("I hear strange noises from the stage", shots) == ["moveTo stage", "take_photo stage"]
