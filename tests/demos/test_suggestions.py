"""What the page offers is understood when it is tapped: examples, places of the map, phrases of actions."""

from __future__ import annotations

from collections import defaultdict

import pytest

from parley.actions.builtin import BUILTIN_ACTIONS
from parley.config import SystemConfig
from parley.demos.catalogue import DEMOS, load_demo
from parley.language.base import Situation
from parley.language.builtin.decision import Answer, Ask, Decision, Do
from parley.language.builtin.engine import BuiltinLanguage
from parley.team.wishes import team_wish
from parley.umrf.catalogue import info_of

ENGINE = BuiltinLanguage()
CATALOGUE = tuple(info_of(spec) for spec in BUILTIN_ACTIONS)
SHOWN = 3
"""So many phrases of an action the page shows."""
HOLES = {"question": "whether it is warm", "name": "the view", "person": "Kim"}


def decided(demo: str, message: str) -> Decision:
    objects = load_demo(demo).objects.objects
    return ENGINE.decide(Situation(message, objects=objects, catalogue=CATALOGUE, robot="A", robots=("A",)))


@pytest.mark.parametrize(("demo", "example"), [(n, text) for n in DEMOS for text in load_demo(n).examples])
def test_what_a_demonstration_suggests_is_done_or_answered(demo: str, example: str) -> None:
    wish = team_wish(example, ("A", "B"))
    orders = [part.order for part in wish.parts] or [f"go to {wish.about}"] if wish else [example]
    for order in orders:
        assert isinstance(decided(demo, order), Answer if order.startswith("What") else Do)


@pytest.mark.parametrize("demo", DEMOS)
def test_what_is_played_on_a_page_leaves_every_yes_to_the_person(demo: str) -> None:
    played = load_demo(demo)
    assert played.tour
    assert not [text for text in played.tour if text.lower().startswith(("yes", "ok"))]


def test_a_demonstration_whose_story_asks_first_does_so_wherever_nobody_said_otherwise() -> None:
    parking, warehouse = load_demo("parking"), load_demo("warehouse")
    assert parking.settled(SystemConfig(speed=2.0)).approval == "ask_first"
    assert parking.settled(SystemConfig(approval="run_at_once")).approval == "run_at_once"
    assert warehouse.settled(SystemConfig()).approval == "run_at_once"


@pytest.mark.parametrize("demo", DEMOS)
async def test_every_thing_of_a_map_can_be_driven_to_as_the_map_says_it(demo: str) -> None:
    objects = load_demo(demo).objects.objects
    for thing in objects:
        decision = decided(demo, f"Go to the {thing.description}.")
        assert isinstance(decision, Do), f"{thing.description}: {decision}"
        found = await ENGINE.ground(str(decision.deeds[0].arguments["target"]), objects)
        assert found.candidates == (thing,)
    point = decided(demo, "Go to the point (1.50, -2.25).")
    assert isinstance(point, Do) and {1.5, -2.25} <= {*point.deeds[0].arguments.values()}


@pytest.mark.parametrize(
    ("action", "phrase"),
    [(info.name, phrase) for info in CATALOGUE for phrase in info.phrases[:SHOWN]],
)
def test_how_an_action_is_asked_for_asks_for_it(action: str, phrase: str) -> None:
    for demo in DEMOS:
        holes = defaultdict(lambda: "the {}", HOLES)
        thing = load_demo(demo).objects.objects[0].description
        decision = decided(demo, phrase.format_map(holes).format(thing))
        assert not isinstance(decision, Ask), decision
        assert isinstance(decision, Do) and decision.deeds[-1].skill.action.name == action
