"""What people said off script, when robots were run by talking to them, class by class."""

from __future__ import annotations

import pytest

from parley.cli.actions import catalogue_with
from parley.gate.orders import NOT_SEEN
from parley.language.base import Turn
from parley.language.builtin.decision import Answer, Ask, Decision, Do, Edit, Remember
from parley.language.builtin.engine import BuiltinLanguage
from parley.language.builtin.lexicon import lexicon
from parley.language.builtin.reply import to_chat
from parley.language.dialogue.state import Asked, Deed, Dialogue, Order
from parley.messages.chat import ActionCall
from parley.messages.memory import MemoryEntry
from parley.messages.status import PlanProposal
from parley.world.geometry import Pose2D
from parley.world.object_map import MapObject
from tests.language.builtin.worlds import situation

ENGINE = BuiltinLanguage()
SHIPPED = catalogue_with(None)[0].for_robot(("drive", "camera")).infos()
PLACES = tuple(
    MapObject(name.replace(" ", "_"), name, x, y)
    for name, x, y in (
        ("bay A", 1.0, 1.0), ("bay B", 8.0, 1.0), ("bay C", 8.0, 9.0), ("post 3", 7.0, 9.0),
        ("turning circle", 3.0, 3.0), ("lift shaft B resting place", 5.0, 5.0),
    )
)  # fmt: skip


def decided(said: str) -> Decision:
    return ENGINE.decide(situation(said, objects=PLACES))


def places(said: str) -> list[str]:
    made = decided(said)
    assert isinstance(made, Do), made
    return list(dict.fromkeys(str(value) for deed in made.deeds for value in deed.arguments.values()))


@pytest.mark.parametrize(
    ("said", "where"),
    [
        ("go to where the turning circle is", ["turning circle"]),
        ("go to bay A by post 3", ["bay A"]),
        ("go via bay A to the turning circle", ["bay A", "turning circle"]),
        ("drive past the turning circle to bay C", ["turning circle", "bay C"]),
        ("go through the wall to bay A", ["bay A"]),
        ("drive to the turning circle, bay A and lift shaft B resting place",
         ["turning circle", "bay A", "lift shaft B resting place"]),
    ],
)  # fmt: skip
def test_a_place_is_where_its_name_says(said: str, where: list[str]) -> None:
    assert places(said) == where


@pytest.mark.parametrize("said", ["bay A", "the turning circle, now", "hello bay B"])
def test_a_name_alone_is_neither_a_greeting_nor_an_order(said: str) -> None:
    made = decided(said)
    assert isinstance(made, Ask) and made.question.startswith("Shall I go to the")


@pytest.mark.parametrize("said", ["water it", "forget what I said about bay A", "do the first one again"])
def test_no_action_is_offered_that_shares_no_word_with_an_order(said: str) -> None:
    made = ENGINE.decide(situation(said, objects=PLACES, catalogue=SHIPPED))
    assert not isinstance(made, Ask) or not made.offer


def test_what_only_a_look_tells_is_said_to_be_so() -> None:
    made = ENGINE.decide(situation("is bay A empty?", objects=PLACES, catalogue=SHIPPED))
    assert isinstance(made, Ask) and made.offer and made.unclear == NOT_SEEN


def test_a_look_goes_on_with_what_is_named_behind_and_then() -> None:
    made = ENGINE.decide(situation("check bay B and then bay C for bags", objects=PLACES, catalogue=SHIPPED))
    assert isinstance(made, Do)
    looked = [str(value) for deed in made.deeds if deed.frame == "LOOK" for value in deed.arguments.values()]
    assert looked == ["bay B for bags", "bay C for bags"]


@pytest.mark.parametrize(
    "said",
    [
        "Somebody else will do the turning circle",
        "somebody parked in bay A without a permit",
        "I can't find my gloves, can you help?",
        "I've lost my keys, could you help me",
        "someone took my pen",
    ],
)
def test_what_others_do_and_what_is_looked_for_alarms_nobody(said: str) -> None:
    made = decided(said)
    assert not (isinstance(made, Ask) and made.alarms)


@pytest.mark.parametrize(
    "said",
    [
        "the old man does not wake up, can you help?",
        "somebody fell, can you help?",
        "someone set the bin on fire",
    ],
)
def test_who_is_in_need_is_heard_although_it_is_asked_politely(said: str) -> None:
    made = decided(said)
    assert isinstance(made, Ask) and made.alarms


def test_where_somebody_is_may_be_said_short() -> None:
    made = decided("Kim's at the turning circle")
    assert isinstance(made, Remember) and made.told[0].text == "Kim's at the turning circle"


@pytest.mark.parametrize(
    ("said", "answer"),
    [("go faster", "rule"), ("undo that", "take back"), ("evening. everything quiet?", "not looked"),
     ("what did I ask you to do?", "not done anything"), ("did you see anyone?", "not looked"),
     ("morning. anything happening?", "nothing to do"), ("how's it going?", "nothing to do"),
     ("what's on your map?", "I can go to"), ("show me your map", "I can go to"),
     ("hi there, who am I talking to?", "a robot"), ("can you pick things up?", "I can do this")],
)  # fmt: skip
def test_small_talk_about_the_robot_is_answered(said: str, answer: str) -> None:
    made = decided(said)
    assert isinstance(made, Answer) and answer in made.text


def test_a_reminder_is_not_said_at_once() -> None:
    assert not isinstance(decided("remind me to ring the dentist"), Do)


@pytest.mark.parametrize(
    ("said", "fact"),
    [
        ("I moved the crate to bay B", "the crate is at bay B"),
        ("I left my gloves in bay B", "my gloves are in bay B"),
        ("we've put the parcels in bay C", "we've put the parcels in bay C"),
    ],
)
def test_where_somebody_put_a_thing_is_where_it_is(said: str, fact: str) -> None:
    made = decided(said)
    assert isinstance(made, Remember) and [told.text for told in made.told] == [fact]
    thing = made.told[0].name.split("_")[-2]
    memory = (MemoryEntry(name=made.told[0].name, data=made.told[0].text),)
    answered = ENGINE.decide(situation(f"where is the {thing}?", objects=PLACES, memory=memory))
    assert isinstance(answered, Answer) and made.told[0].text in answered.text


def test_what_must_not_be_done_and_is_not_understood_is_asked_about() -> None:
    made = decided("don't block the turning circle")
    assert isinstance(made, Ask) and "block" in made.question


@pytest.mark.parametrize(
    ("said", "told"),
    [
        ("where are bay A and post 3?", ["Bay A is ", "Post 3 is "]),
        ("where is bay B and where is bay C", ["Bay B is ", "Bay C is "]),
        (
            "how far are bay A, post 3 and the turning circle?",
            ["Bay A is ", "Post 3 is ", "turning circle is "],
        ),
        ("where is bay A?", ["Bay A is "]),
        ("where are bay A and the tractor?", ["Bay A is ", "do not know anything about the tractor"]),
    ],
)
def test_each_thing_is_told_that_is_asked_for_in_one(said: str, told: list[str]) -> None:
    made = decided(said)
    assert isinstance(made, Answer)
    assert [one for one in told if one not in made.text] == []


def test_where_another_robot_is_that_robot_tells() -> None:
    robots = ("Ada", "Bob")
    asked = ENGINE.decide(situation("where is Bob?", objects=PLACES, robots=robots))
    assert isinstance(asked, Answer) and "where are you?" in asked.text
    itself = ENGINE.decide(situation("where is Ada?", objects=PLACES, robots=robots))
    assert not (isinstance(itself, Answer) and "Ask Ada" in itself.text)


@pytest.mark.parametrize(
    ("said", "where"),
    [
        ("Mr Bauer is asleep. Go to his room", ["room 5"]),
        ("drive to Mr Bauer's room", ["room 5"]),
        ("I have the family of Mr Bauer here. Can you drive to his room?", "Whose room"),
    ],
)
def test_somebodys_room_is_where_it_was_told_that_they_live(said: str, where: list[str] | str) -> None:
    rooms = tuple(
        MapObject(name.replace(" ", "_"), name, float(at), 1.0)
        for at, name in enumerate(("room 1", "room 5", "dining room"))
    )
    memory = (MemoryEntry(name="bauer_room", data="Mr Bauer lives in room 5"),)
    made = ENGINE.decide(situation(said, objects=rooms, memory=memory))
    if isinstance(where, str):
        assert isinstance(made, Ask) and where in made.question
    else:
        assert isinstance(made, Do) and [*made.deeds[0].arguments.values()] == where


def test_who_leaves_is_not_greeted() -> None:
    made = decided("that's all, goodnight")
    assert isinstance(made, Answer) and made.text == "Goodbye."


def test_it_is_the_thing_that_was_told_of_and_not_what_it_lies_on() -> None:
    fact = "my book is on the turning circle"
    memory = (MemoryEntry(name="book_location", data=fact),)
    history = (Turn("operator", fact), Turn("assistant", f"I will remember that {fact}."))
    made = ENGINE.decide(situation("bring it to bay A", objects=PLACES, memory=memory, history=history))
    assert isinstance(made, Do)
    assert "book" in [deed.arguments.get("item") for deed in made.deeds]


def test_the_same_of_another_thing_is_asked_of_that_thing() -> None:
    first = decided_shipped("check whether bay A is free")
    assert isinstance(first, Do)
    order = Order("check whether bay A is free", calls=to_chat(first, lexicon()).queue)
    made = decided_shipped("and bay C", dialogue=Dialogue(orders=(order,)))
    assert isinstance(made, Edit)
    said = [str(p.value) for call in made.change.add for p in call.input_parameters.values() if p.has_data]
    assert said == ["bay C", "whether bay C is free"]


def decided_shipped(said: str, **more: object) -> Decision:
    return ENGINE.decide(situation(said, objects=PLACES, catalogue=SHIPPED, **more))


@pytest.mark.parametrize(
    "said", ["open the skylight", "turn off the radio", "mop the floor", "cook some rice"]
)
def test_what_no_action_does_is_said_before_it_is_asked_what_is_meant(said: str) -> None:
    made = decided_shipped(said)
    assert isinstance(made, Ask) and made.question.startswith("I have no action to")


@pytest.mark.parametrize(
    ("said", "done"),
    [
        ("inspect bay A, then bay B, then bay C", "LOOK LOOK LOOK"),
        ("photograph bay A, then bay B", "PHOTO PHOTO"),
        ("check bay A, then back to bay B", "LOOK"),
        ("take two pictures of bay A", "PHOTO PHOTO"),
        ("could you do me a favour and check bay A", "LOOK"),
        ("take a look around", "LOOK"),
    ],
)
def test_all_that_is_wanted_is_done_at_each_and_as_often_as_was_said(said: str, done: str) -> None:
    made = ENGINE.decide(situation(said, objects=PLACES, catalogue=SHIPPED))
    assert isinstance(made, Do)
    assert " ".join(deed.frame for deed in made.deeds if deed.frame in ("LOOK", "PHOTO")) == done


@pytest.mark.parametrize("said", ["Robin should check bay A", "Robin to check bay A"])
def test_what_somebody_else_should_do_is_asked_about(said: str) -> None:
    made = ENGINE.decide(situation(said, objects=PLACES, catalogue=SHIPPED))
    assert isinstance(made, Ask) and made.called == "Robin"


@pytest.mark.parametrize(
    ("said", "fact"),
    [
        ("Anna will bring the keys to bay A", "Anna will bring the keys to bay A"),
        ("I will put the keys in bay A", "I will put the keys in bay A"),
        ("Anna brought the keys to bay A", "the keys are at bay A"),
    ],
)
def test_what_is_still_to_come_is_remembered_as_that(said: str, fact: str) -> None:
    made = ENGINE.decide(situation(said, objects=PLACES, catalogue=SHIPPED))
    assert isinstance(made, Remember) and made.told[0].text == fact


def test_an_order_to_another_robot_takes_nothing_of_what_this_one_offered() -> None:
    offered = Dialogue(proposal=PlanProposal(id="7", target="Ada", why="It is not certain."))
    made = decided_shipped("Bob, go to bay A", robots=("Ada", "Bob"), dialogue=offered)
    assert isinstance(made, Do) and made.robots == ("Bob",)
    both = decided_shipped("Ada and Bob, go to bay A", robots=("Ada", "Bob"), dialogue=offered)
    assert isinstance(both, Edit)  # Ada is meant, too, so that what she offered gives way


YARD = tuple(
    MapObject(name.replace(" ", "_"), name, x, y)
    for name, x, y in (("pump by the door", 1.0, 1.0), ("pump in the yard", 8.0, 1.0), ("desk", 8.0, 9.0),
                       ("large crate", 4.0, 4.0), ("small crate", 5.0, 9.0))
)  # fmt: skip


def after(past: str, said: str) -> Decision:
    past_turns = (Turn("operator", past),)
    return ENGINE.decide(situation(said, objects=YARD, catalogue=SHIPPED, history=past_turns))


def targets(made: Decision) -> set[object]:
    assert isinstance(made, Do), made
    return {value for deed in made.deeds for value in deed.arguments.values()}


def test_one_that_is_somewhere_else_is_another_one() -> None:
    assert targets(after("check the pump by the door", "now check the one in the yard")) == {
        "pump in the yard"
    }
    assert isinstance(after("check the desk", "check the one in the yard"), Ask)


@pytest.mark.parametrize("said", ["go to the crate, the large one", "go to the big crate"])
def test_which_of_several_may_be_said_behind_it_and_in_another_word(said: str) -> None:
    assert targets(ENGINE.decide(situation(said, objects=YARD, catalogue=SHIPPED))) == {"large crate"}


def test_how_the_thing_is_that_was_spoken_of_is_offered_to_be_looked_at() -> None:
    made = after("go to the desk", "is there a cup on it?")
    assert isinstance(made, Ask)
    assert {value for deed in made.offer for value in deed.arguments.values()} >= {"desk"}
    assert isinstance(after("go to the desk", "is it raining?"), Answer)


def test_what_was_not_done_is_not_said_to_be_done() -> None:
    drove = Deed("Go to “desk”", ActionCall(name="NavigateTo"), effects=("moves",), ending="done")
    said = situation("did you give it to her?", dialogue=Dialogue(deeds=(drove,), now_unix_ms=1))
    made = ENGINE.decide(said)
    assert isinstance(made, Answer)
    assert made.text.startswith("No.")


@pytest.mark.parametrize(
    "said", ["tell me when you are back at the desk", "let me know when the desk is free"]
)
def test_what_is_to_be_told_later_is_no_way_there_now(said: str) -> None:
    assert isinstance(ENGINE.decide(situation(said, objects=YARD, catalogue=SHIPPED)), Ask)


def test_what_is_to_be_remembered_is_no_picture() -> None:
    said = "remember that the forklift parks at the desk"
    assert isinstance(ENGINE.decide(situation(said, objects=YARD, catalogue=SHIPPED)), Remember)


def test_a_set_is_known_by_an_irregular_plural() -> None:
    shelves = tuple(MapObject(f"shelf_{n}", f"shelf {n}", float(n), 1.0) for n in (1, 2))
    made = ENGINE.decide(situation("check all shelves", objects=shelves, catalogue=SHIPPED))
    assert targets(made) == {"shelf 1", "shelf 2"}


CRATES = tuple(
    MapObject(name.replace(" ", "_"), name, x, 1.0)
    for name, x in (("old crate", 2.0), ("new crate", 7.0), ("gate", 9.0))
)


def told(said: str, *before: str, **more: object) -> Decision:
    history = tuple(Turn("operator", text) for text in before)
    pose = Pose2D(1.0, 1.0, 0.0)
    known = {"objects": CRATES, "catalogue": SHIPPED, "robot_pose": pose, "history": history}
    return ENGINE.decide(situation(said, **(known | more)))


@pytest.mark.parametrize(
    ("said", "near"),
    [
        ("where's the nearest crate?", "The old crate is"),
        ("which crate is closest to the gate?", "The new crate is"),
        ("which crate is furthest?", "The new crate is"),
        ("which is closer, the gate or the new crate?", "The new crate is"),
        ("how far is the old crate from the gate?", "By my map they are about 7 metres apart."),
        ("how far is it from the old crate to the gate?", "By my map they are about 7 metres apart."),
        ("what's around here?", "By my map: the old crate"),
    ],
)
def test_what_is_nearest_is_told_from_the_map(said: str, near: str) -> None:
    made = told(said)
    assert isinstance(made, Answer)
    assert made.text.startswith(near)


def test_what_was_asked_about_last_is_meant_by_it_and_asked_where_it_was_several_things() -> None:
    made = told("go to it", "go to the gate", "where's the nearest crate?")
    assert isinstance(made, Do)
    assert made.deeds[0].arguments == {"target": "old crate"}
    assert isinstance(told("go to it", "go to the gate", "are there any crates?"), Ask)


@pytest.mark.parametrize(
    "said",
    ["could you see if the gate is locked", "is the gate locked or not?", "anything at the gate right now?"],
)
def test_what_only_a_look_tells_is_looked_at_or_offered(said: str) -> None:
    made = told(said)
    deeds = made.offer if isinstance(made, Ask) else made.deeds if isinstance(made, Do) else ()
    assert [deed.frame for deed in deeds if not deed.hidden] == ["GO", "LOOK"]


def test_what_is_no_fact_of_a_place_is_offered_to_be_remembered_and_a_yes_says_so() -> None:
    said = "We expect a visitor at the gate at ten"
    asked = told(said)
    assert isinstance(asked, Ask)
    assert asked.choices == ("remember that we expect a visitor at the gate at ten",)
    kept = told("yes", said)
    assert isinstance(kept, Remember)
    assert [fact.text for fact in kept.told] == ["we expect a visitor at the gate at ten"]
    assert not isinstance(told("yes", said, "where is the old crate?"), Remember)


def test_she_is_who_was_told_of_by_name_and_nobody_else() -> None:
    kept = told("she is at the gate", "Anna would like a glass of water")
    assert isinstance(kept, Remember)
    assert [fact.text for fact in kept.told] == ["Anna is at the gate"]
    other = told("she is at the gate", "Ada, Kim's bag is at the old crate")
    assert isinstance(other, Remember)
    assert [(fact.name, fact.text) for fact in other.told] == [("kim_location", "Kim is at the gate")]
    lost = told("she is at the gate", "Check the old crate")
    assert isinstance(lost, Ask) and not lost.choices


def test_what_is_called_with_another_article_is_that_thing_and_no_other() -> None:
    crates = (MapObject("1", "crate", 1.0, 1.0), MapObject("2", "crate with a lid", 5.0, 5.0))
    for said in ("go to the crate with the lid", "go to the crate, the one with the lid"):
        made = told(said, objects=crates)
        assert isinstance(made, Do)
        assert made.deeds[0].arguments == {"target": "crate with a lid"}


def test_a_place_is_taken_as_a_way_and_never_picked_up() -> None:
    bays = (MapObject("1", "charging dock", 1.0, 1.0), MapObject("2", "gate", 5.0, 5.0))
    assert isinstance(told("pick up the dock", objects=bays), Ask)
    assert isinstance(told("can you pick it up?", "go to the dock", objects=bays), Ask)
    assert isinstance(told("take the dock", objects=bays), Do)


@pytest.mark.parametrize("said", ["show me the first one", "photograph the second one"])
def test_no_picture_is_taken_of_one_that_nobody_knows(said: str) -> None:
    assert isinstance(told(said), Ask)


def test_who_wants_to_know_has_it_looked_at_and_who_wonders_is_asked() -> None:
    assert isinstance(told("I need to know if the gate is locked"), Do)
    wondered = told("I wonder if the gate is locked")
    assert isinstance(wondered, Ask) and wondered.offer


@pytest.mark.parametrize(
    "said",
    [
        "check whether there's a leak at the old crate and the gate",
        "check if there are any leaks at the old crate and at the gate",
        "check the old crate and the gate and tell me if you see any leaks",
    ],
)
def test_each_place_that_is_named_in_what_is_looked_for_is_looked_at(said: str) -> None:
    made = told(said)
    assert isinstance(made, Do)
    shown = [deed for deed in made.deeds if not deed.hidden]
    ways = [str(deed.arguments["target"]) for deed in made.deeds if deed.hidden]
    assert ways == ["old crate", "gate"]
    assert shown[-1].frame in ("LOOK", "FIND")
    assert all(" and " not in str(value) for deed in shown for value in deed.arguments.values())


def test_how_many_stand_at_a_place_is_told_of_that_place_alone() -> None:
    yard = (*CRATES, MapObject("y", "yard", 2.0, 1.0, width_m=3.0, height_m=3.0))
    made = told("how many crates are in the yard?", objects=yard)
    assert isinstance(made, Answer)
    assert made.text == "On my map there is the old crate."
    none = told("how many crates are at the gate?")
    assert isinstance(none, Answer)
    assert none.text.startswith("By my map there is none there.")


def test_a_look_is_offered_for_the_last_sentence_of_several() -> None:
    for said in ("We've got a visitor coming. Is the gate clear?", "Is the gate clear? We need it"):
        made = told(said)
        assert isinstance(made, Ask) and made.offer


def test_a_call_by_name_is_no_part_of_what_is_told() -> None:
    made = told("Ada, Maie's medicine is at the gate")
    assert isinstance(made, Remember)
    assert [fact.text for fact in made.told] == ["Maie's medicine is at the gate"]


def test_what_is_told_behind_a_wait_is_told() -> None:
    made = told("wait, that was yesterday. they are on the gate", "my keys are on the old crate")
    assert isinstance(made, Remember)


def test_what_only_answers_calls_up_no_action_of_the_robots_own() -> None:
    made = told("it's on you now")
    assert isinstance(made, Ask) and not made.offer


@pytest.mark.parametrize("said", ["?", "what?!", "and? or not", "Ada?", "is? it"])
def test_a_question_of_few_words_ends_no_run(said: str) -> None:
    assert told(said, "go to the gate") is not None


SHELVES = tuple(MapObject(name, name, x, 1.0) for name, x in (("bay 1", 1.0), ("bay 2", 5.0), ("bay A", 9.0)))


def test_a_kind_is_asked_about_where_numbers_or_letters_tell_things_apart() -> None:
    made = ENGINE.decide(situation("go to the bay", objects=SHELVES, catalogue=SHIPPED))
    assert isinstance(made, Ask) and made.choices == ("bay 1", "bay 2", "bay A")


@pytest.mark.parametrize(
    ("said", "where"),
    [
        ("go to bay 1, bay 2 and bay A, start with bay 2", ["bay 2", "bay 1", "bay A"]),
        ("check bay 1 and bay A, A first please", ["bay A", "bay 1"]),
        ("check bay 1 and bay 2. Finish with bay 1.", ["bay 2", "bay 1"]),
        ("go to bay 1, start with bay 2", None),
        ("on your way back look at bay 2", ["bay 2"]),
    ],
)
def test_what_comes_first_is_said_beside_an_order(said: str, where: list[str] | None) -> None:
    made = ENGINE.decide(situation(said, objects=SHELVES, catalogue=SHIPPED))
    told = [str(v) for deed in made.deeds for v in deed.arguments.values()] if isinstance(made, Do) else []
    assert [*dict.fromkeys(told)] == (where or [])


@pytest.mark.parametrize(
    ("said", "told"),
    [
        ("is the parcel in bay 2?", "Shall I go and look?"),
        ("what is between bay 1 and bay A?", "By my map: the bay 2."),
        ("where can you go?", "I can go to the bay 1, the bay 2 or the bay A."),
        ("never mind, go back to the moon", "I do not know any “moon” here"),
        ("a van is parked by bay 2", "For now I keep in mind that a van is parked by bay 2. Shall I go to"),
        ("great, remember the parcel is packed", "I will remember that the parcel is packed."),
        ("remember the driver comes at five", "I will remember that the driver comes at five."),
        ("great, remember it's packed", "I did not understand that."),
        ("quick, is bay 2 free?", "Shall I go and look?"),
        ("take a picture of the torn bay", "“torn bay” here. Which one do you mean: bay 1, bay 2 or bay A?"),
        ("check bay 1 and bay 2, and stop if you see a leak", "I will remember: stop if you see a leak."),
        ("go to bay 1. If you see a leak, tell me", "I will remember: If you see a leak, tell me."),
        (
            "do a round of bay 1 and bay A and stop if there's a leak",
            "I will remember: stop if you see a leak.",
        ),
        ("go to bay 1 and tell me when you are there", "I will go to bay 1."),
        ("tell me when you are done", "I tell you as soon as I am done."),
        ("are you there?", "Yes, I hear you."),
        ("when you've got a minute go to bay 1", "I will go to bay 1."),
        ("go to bay 1 and in the end to bay A", "I will go to bay 1 and then go to bay A."),
        ("turn a little to the left", "30 degrees"),
        ("be quiet around him", "I do not understand “quiet” in this."),
    ],
)
def test_what_was_said_off_script_is_answered(said: str, told: str) -> None:
    made = ENGINE.decide(situation(said, objects=SHELVES, catalogue=SHIPPED))
    assert told in to_chat(made, lexicon()).message_response


@pytest.mark.parametrize(
    ("said", "answer", "where"),
    [
        ("go to the holding room", "yes", ["holding area"]),
        ("go to the torn post and then to the holding area", "the second one", ["post 2", "holding area"]),
        ("look at the torn post", "post 1", ["post 1"]),
    ],
)
def test_who_is_asked_which_one_names_it_in_place_of_what_nobody_knows(
    said: str, answer: str, where: list[str]
) -> None:
    objects = tuple(
        MapObject(n, n, x, 1.0) for n, x in (("holding area", 1.0), ("post 1", 5.0), ("post 2", 9.0))
    )
    asked = ENGINE.decide(situation(said, objects=objects, catalogue=SHIPPED))
    assert isinstance(asked, Ask)
    dialogue = Dialogue(asked=Asked(asked.about, asked.choices))
    made = ENGINE.decide(situation(answer, objects=objects, catalogue=SHIPPED, dialogue=dialogue))
    assert isinstance(made, Do)
    assert [*dict.fromkeys(str(v) for deed in made.deeds for v in deed.arguments.values())] == where


@pytest.mark.parametrize(
    ("asked", "said", "kept", "where"),
    [
        ("find the parcel", "it's in bay 2, I think", "", ["bay 2", "parcel"]),
        ("is the parcel still here?", "try bay A", "", ["bay A", "parcel"]),
        ("where's Kim?", "she is at bay 2", "Kim is at bay 2", []),
    ],
)
def test_where_to_look_for_what_nobody_knows_is_asked_and_answered(
    asked: str, said: str, kept: str, where: list[str]
) -> None:
    found = ENGINE.decide(situation(asked, objects=SHELVES, catalogue=SHIPPED))
    assert isinstance(found, Ask) and "Where shall I look?" in found.question
    dialogue = Dialogue(asked=Asked(found.about or asked, found.choices, found.where))
    past = (Turn("operator", asked), Turn("assistant", found.question))
    made = ENGINE.decide(situation(said, objects=SHELVES, catalogue=SHIPPED, dialogue=dialogue, history=past))
    assert isinstance(made, Do | Remember)
    assert [fact.text for fact in made.told] == ([kept] if kept else [])
    told = [str(v) for deed in made.deeds for v in deed.arguments.values()] if isinstance(made, Do) else []
    assert [*dict.fromkeys(told)] == where


def test_it_is_what_was_wanted_and_not_where_that_lies() -> None:
    kept = (MemoryEntry(name="coat_location", data="the coat is in bay 2"),)
    past = (
        Turn("operator", "fetch my coat"),
        Turn("assistant", "Where is it?"),
        Turn("operator", "in bay 2"),
    )
    made = ENGINE.decide(
        situation("bring it to bay A", objects=SHELVES, catalogue=SHIPPED, memory=kept, history=past)
    )
    assert isinstance(made, Do)
    assert "coat" in {str(v) for deed in made.deeds if deed.frame == "FIND" for v in deed.arguments.values()}


@pytest.mark.parametrize(
    ("before", "said", "answer"),
    [
        ("is Kim awake?", "she's usually in bay 2", "I will remember that Kim's usually in bay 2."),
        ("go to the ramp", "no sorry, I mean the bay 2", "I will go to bay 2."),
        ("where is the ramp?", "the bay 2, I mean", "Bay 2 is"),
        ("hello", "good. and the bay 2, is it clear?", "Shall I go and look?"),
        ("hello", "Hi, I am Kim and I am by bay 2", "I will remember that the operator is by bay 2."),
    ],
)
def test_who_or_what_is_meant_may_be_said_afterwards(before: str, said: str, answer: str) -> None:
    past = (Turn("operator", before), Turn("assistant", "I do not know anything about that."))
    made = ENGINE.decide(situation(said, objects=SHELVES, catalogue=SHIPPED, history=past))
    assert answer in to_chat(made, lexicon()).message_response


def test_thanks_leave_no_question_unheard() -> None:
    made = decided("thanks. how about the parcel, do you know where somebody put that?")
    assert isinstance(made, Answer | Ask) and "parcel" in to_chat(made, lexicon()).message_response


def test_what_is_lost_is_not_the_place_where_it_was() -> None:
    past = (Turn("operator", "my wallet is gone, I had it somewhere near bay 2"),)
    made = ENGINE.decide(situation("go look for it", objects=SHELVES, catalogue=SHIPPED, history=past))
    assert isinstance(made, Ask)


def test_what_was_ordered_last_is_told() -> None:
    dialogue = Dialogue(orders=(Order("go to bay 1", "Kim", 1_700_000_000_000),))
    made = ENGINE.decide(situation("what did I just say?", objects=SHELVES, dialogue=dialogue))
    assert isinstance(made, Answer) and "You said: “go to bay 1”." in made.text


def test_somebody_asleep_is_in_no_danger() -> None:
    made = decided("Rein fell asleep in bay A, be quiet around him")
    assert not (isinstance(made, Ask) and made.alarms)


STORES = tuple(
    MapObject(name, name, x, 1.0)
    for name, x in (("Store A holding area", 1.0), ("Store B holding area", 5.0), ("ramp area", 9.0))
)


@pytest.mark.parametrize(
    ("said", "where"),
    [
        ("go to store B", ["Store B holding area"]),
        ("drive to holder area B", ["Store B holding area"]),
        ("go to store b holding area", ["Store B holding area"]),
        ("go to store C", []),
        ("go to the holding room", []),
    ],
)
def test_a_long_name_is_known_by_its_letter_and_whole_by_any_case(said: str, where: list[str]) -> None:
    made = ENGINE.decide(situation(said, objects=STORES, catalogue=SHIPPED))
    told = [str(v) for deed in made.deeds for v in deed.arguments.values()] if isinstance(made, Do) else []
    assert [*dict.fromkeys(told)] == where


@pytest.mark.parametrize(
    ("said", "kept"),
    [
        ("tell me if you see anybody", True),
        ("call me as soon as you notice water", True),
        ("shout if you see smoke", True),
        ("if you see anything tell me", False),  # nothing could ever be held against that
        ("let me know when you see it", False),
        ("look at bay A and tell me if there is water in it", False),
    ],
)
def test_what_is_to_be_told_when_it_is_seen_is_a_rule(said: str, kept: bool) -> None:
    made = ENGINE.decide(situation(said, objects=PLACES, catalogue=SHIPPED))
    assert any(fact.is_rule for fact in getattr(made, "told", ())) is kept


@pytest.mark.parametrize("said", ["have a quick look at bay A", "take a good look whether bay A is empty"])
def test_how_a_look_is_called_changes_nothing_of_it(said: str) -> None:
    made = ENGINE.decide(situation(said, objects=PLACES, catalogue=SHIPPED))
    assert isinstance(made, Do) and made.deeds[-1].frame == "LOOK"


def test_what_the_map_has_of_a_kind_is_counted() -> None:
    made = decided("how many bays are there?")
    assert isinstance(made, Answer) and made.text == "On my map there are 3: bay A, bay B and bay C."


def test_what_stands_elsewhere_was_not_missed_by_the_last_look() -> None:
    look = Deed(
        "Look at bay A",
        ActionCall(name="Inspect"),
        ("looks",),
        ending="done",
        unix_ms=1_700_000_000_000,
        seen=("wall",),
    )
    dialogue = Dialogue(deeds=(look,), now_unix_ms=1_700_000_100_000)
    made = ENGINE.decide(
        situation("is bay C still there?", objects=PLACES, catalogue=SHIPPED, dialogue=dialogue)
    )
    assert isinstance(made, Ask) and made.offer


def test_two_things_that_are_not_clear_are_asked_about_one_after_the_other() -> None:
    words = "go to the bay and the post"
    things = (*PLACES[:2], MapObject("p1", "post 1", 1.0, 2.0), MapObject("p2", "post 2", 2.0, 2.0))
    first = ENGINE.decide(situation(words, objects=things))
    assert isinstance(first, Ask) and first.choices == ("bay A", "bay B")
    asked = Dialogue(asked=Asked(words, first.choices))
    second = ENGINE.decide(situation("bay B", objects=things, dialogue=asked))
    assert isinstance(second, Ask) and second.choices == ("post 1", "post 2")
    asked = Dialogue(asked=Asked(second.about, second.choices))
    made = ENGINE.decide(situation("post 2", objects=things, dialogue=asked))
    assert isinstance(made, Do)
    assert [deed.arguments["place"] for deed in made.deeds] == ["bay B", "post 2"]


@pytest.mark.parametrize(
    ("said", "where"),
    [
        ("check both the turning circle and the lift shaft B resting place", 2),
        ("wait at the turning circle until I call you", 1),
    ],
)
def test_what_is_joined_begun_with_or_waited_for_is_done(said: str, where: int) -> None:
    made = ENGINE.decide(situation(said, objects=PLACES, catalogue=SHIPPED))
    assert isinstance(made, Do)
    assert sum(deed.frame == "GO" and not deed.hidden for deed in made.deeds) == where
    assert made.deeds[-1].frame in ("LOOK", "WAIT")


def test_a_noun_is_no_verb_behind_its_article() -> None:
    made = decided("my phone should be at the turning circle, can you check")
    assert isinstance(made, Ask) or "phone" not in getattr(made, "text", "")


def test_what_is_begun_with_may_be_told_by_where_it_is() -> None:
    names = ("tall crate", "crate by the ramp", "crate by the gate")
    things = tuple(MapObject(name, name, float(at), 1.0) for at, name in enumerate(names))
    made = ENGINE.decide(
        situation("check all crates but start with the one by the gate", objects=things, catalogue=SHIPPED)
    )
    assert isinstance(made, Do)
    looked = [str(value) for deed in made.deeds if deed.frame == "LOOK" for value in deed.arguments.values()]
    assert looked == ["crate by the gate", "tall crate", "crate by the ramp"]


def test_a_part_of_a_thing_is_looked_at_where_the_thing_is() -> None:
    made = ENGINE.decide(situation("check the rim of the turning circle", objects=PLACES, catalogue=SHIPPED))
    assert isinstance(made, Do)
    told = [str(value) for deed in made.deeds for value in deed.arguments.values()]
    assert told == ["turning circle", "rim of the turning circle"]


@pytest.mark.parametrize(
    ("said", "looks"),
    [("has bay A been swept?", True), ("was bay A open?", False), ("does bay A leak?", False)],
)
def test_where_something_is_answers_no_question_how_it_is(said: str, looks: bool) -> None:
    made = ENGINE.decide(situation(said, objects=PLACES, catalogue=SHIPPED))
    assert (isinstance(made, Ask) and bool(made.offer)) is looks
    assert "metres" not in to_chat(made, lexicon()).message_response


def test_what_the_map_has_not_there_is_looked_for_there() -> None:
    made = ENGINE.decide(situation("check all posts in bay B", objects=TWO_POSTS, catalogue=SHIPPED))
    assert isinstance(made, Do)
    told = [str(value) for deed in made.deeds for value in deed.arguments.values()]
    assert told == ["bay B", "bay B for all posts"]


def test_nobody_is_part_of_a_thing_and_nobody_drives_to_a_part() -> None:
    for said in ("go to the owner of the turning circle", "look at the owner of the turning circle"):
        assert not isinstance(ENGINE.decide(situation(said, objects=PLACES, catalogue=SHIPPED)), Do)


TWO_POSTS = (*PLACES, MapObject("post_4", "post 4", 1.0, 9.0))


@pytest.mark.parametrize(
    ("said", "told"),
    [
        ("look under the turning circle", ["turning circle", "what is under the turning circle"]),
        ("check behind bay A", ["bay A", "what is behind bay A"]),
        ("look by the turning circle", ["turning circle", "what is by the turning circle"]),
        ("look into bay C", ["bay C", "bay C"]),
        ("take a photo of what's behind the turning circle", ["turning circle", "turning circle"]),
    ],
)
def test_where_one_looks_is_told_by_a_place_alone(said: str, told: list[str]) -> None:
    made = ENGINE.decide(situation(said, objects=PLACES, catalogue=SHIPPED))
    assert isinstance(made, Do)
    assert [str(value) for deed in made.deeds for value in deed.arguments.values()] == told


@pytest.mark.parametrize(
    ("said", "where"),
    [
        ("no, the turning circle", "turning circle"),  # none of those
        ("I mean post 3", "post 3"),
        ("any", "bay A"),
        ("whichever is closer", "bay A"),
        ("you choose", "bay A"),
        ("the other one", None),
    ],
)
def test_a_choice_may_be_left_to_the_robot_or_be_for_something_else(said: str, where: str | None) -> None:
    asked = Dialogue(asked=Asked("go to the bay", ("bay A", "bay B", "bay C")))
    here = situation(said, objects=PLACES, dialogue=asked, robot_pose=Pose2D(0.0, 0.0, 0.0))
    made = ENGINE.decide(here)
    assert isinstance(made, Do) is (where is not None)
    if isinstance(made, Do):
        assert [deed.arguments["place"] for deed in made.deeds] == [where]


def test_where_one_looks_may_have_been_spoken_of_before() -> None:
    past = (Turn("operator", "go to the turning circle"),)
    made = ENGINE.decide(situation("look under it", objects=PLACES, catalogue=SHIPPED, history=past))
    assert isinstance(made, Do)
    told = [str(value) for deed in made.deeds for value in deed.arguments.values()]
    assert told == ["turning circle", "what is under the turning circle"]


@pytest.mark.parametrize("said", ["look there", "look in bays A to C whether the lights are on"])
def test_no_look_is_made_of_a_word_for_some_place(said: str) -> None:
    made = ENGINE.decide(situation(said, objects=PLACES, catalogue=SHIPPED))
    told = [str(value) for deed in getattr(made, "deeds", ()) for value in deed.arguments.values()]
    assert not any(text.startswith("what is ") for text in told)
