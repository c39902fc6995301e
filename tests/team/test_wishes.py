"""How people spread work over several robots: what is read, and what is left alone."""

from __future__ import annotations

import pytest

from parley.files import words_in
from parley.team.wish import Part
from parley.team.wishes import asked_by_name, gathered, is_unread, team_wish, turned_wish

ROBOTS = ("Ada", "Kim")
SAYS = [(kind, say) for kind, says in words_in("parley.team", "wishes")["tests"].items() for say in says]


@pytest.mark.parametrize(("kind", "say"), SAYS)
def test_sentences_of_the_data_are_read_as_it_says(kind: str, say: str) -> None:
    wish = team_wish(say, ROBOTS)
    assert (wish.kind if wish is not None else "none") == kind
    assert team_wish(say, ("Ada",)) is None  # one robot is no team


@pytest.mark.parametrize(
    ("say", "parts"),
    [
        ("Could one of you please check the gate?", [Part("one", "check the gate")]),
        (
            "one of you fetches the box, the others wait at the dock",
            [Part("one", "fetch the box"), Part("rest", "wait at the dock")],
        ),
        (
            "Ada opens the way to the gate, Kim follows when it is there",
            [Part("named", "go to the gate", "Ada"), Part("named", "go to the gate", "Kim", after=True)],
        ),
        (
            "Ada goes to the gate. When Ada is there, Kim goes to the desk.",
            [Part("named", "go to the gate", "Ada"), Part("named", "go to the desk", "Kim", after=True)],
        ),
        (
            "Ada goes to the gate, Kim goes to the desk when Ada is there",
            [Part("named", "go to the gate", "Ada"), Part("named", "go to the desk", "Kim", after=True)],
        ),
        ("go back home, all of you", [Part("all", "go back home")]),
        ("let Kim do that", [Part("named", "", "Kim")]),
        (
            "two of you go to the gate, the other one waits at the dock",
            [Part("some", "go to the gate", count=2), Part("rest", "wait at the dock")],
        ),
        ("the nearest of you should check the gate", [Part("one", "check the gate", nearest=True)]),
        ("everybody but Kim go to the dock", [Part("all", "go to the dock", without=("Kim",))]),
        (
            "go to the dock, all of you except Ada and Kim",
            [Part("all", "go to the dock", without=("Ada", "Kim"))],
        ),
        ("don't send Kim. Check all boxes between you", [Part("all", "Check all boxes", without=("Kim",))]),
        (
            "Ada takes box 2, the others look at box 3",
            [
                Part("named", "take box 2", "Ada", alike="look at box 2"),
                Part("rest", "look at box 3", without=("Ada",)),
            ],
        ),
        ("Ada broke down. Kim, finish its box", [Part("named", "", "Kim", of="Ada")]),
        ("Ada's stuck, someone take over", [Part("one", "", of="Ada")]),
        ("somebody else do Ada's share", [Part("one", "", of="Ada")]),
        ("Kim, finish what Ada had to do", [Part("named", "", "Kim", of="Ada")]),
        ("station one robot at each door", [Part("all", "go to every door")]),
        (
            "let one robot check the gate and one stay at the dock",
            [Part("one", "check the gate"), Part("one", "stay at the dock")],
        ),
        (
            "keep Ada at the dock, send the other one to the gate",
            [Part("named", "go to the dock", "Ada"), Part("rest", "go to the gate", without=("Ada",))],
        ),
        ("recall all robots", [Part("all", "", home=True)]),
        ("call Kim back to the gate", [Part("named", "go back to the gate", "Kim")]),
        ("Kim, not you", [Part("named", "", "Kim", instead=True)]),
        ("not Ada, take Kim for that", [Part("named", "", "Kim", of="Ada", instead=True)]),
        (
            "when Ada is done with that, Kim goes to the gate",
            [Part("named", "go to the gate", "Kim", after=True, awaits="Ada")],
        ),
        (
            "Ada goes to the gate, Kim can rest",
            [Part("named", "go to the gate", "Ada"), Part("named", "", "Kim", stays=True)],
        ),
        ("whoever has the most battery should check the gate", [Part("one", "check the gate", fullest=True)]),
        ("Everybody back!", [Part("all", "", home=True)]),
        ("each of you check a different box", [Part("all", "check every box")]),
        (
            "Ada and Kim, check the gate and the desk respectively",
            [Part("named", "check the gate", "Ada"), Part("named", "check the desk", "Kim")],
        ),
        (
            "Kim, wait until Ada is back and then go to the gate",
            [Part("named", "go to the gate", "Kim", after=True, awaits="Ada")],
        ),
        (
            "Kim, as soon as Ada gets there, go to the gate",
            [Part("named", "go to the gate", "Kim", after=True, awaits="Ada")],
        ),
        ("check the gate with two robots", [Part("some", "check the gate", count=2)]),
        (
            "one of you stay here, the others go to the dock",
            [Part("one", "", stays=True), Part("rest", "go to the dock")],
        ),
    ],
)
def test_who_does_what_is_told_apart_from_the_work(say: str, parts: list[Part]) -> None:
    wish = team_wish(say, ROBOTS)
    assert wish is not None
    assert [*wish.parts] == parts


@pytest.mark.parametrize(
    ("say", "robot", "asked"),
    [
        ("where is Kim?", "Kim", "where are you?"),
        ("what are you all doing?", "", "what are you doing?"),
        ("who is doing the gate?", "", "what are you doing?"),
        ("has anybody found anything?", "", "have you found anything?"),
        ("which of you is free?", "", "are you free?"),
        ("where is everybody?", "", "where are you?"),
    ],
)
def test_what_is_asked_about_robots_each_of_them_is_asked(say: str, robot: str, asked: str) -> None:
    wish = team_wish(say, ROBOTS)
    assert wish is not None
    assert (wish.kind, wish.robot, wish.about) == ("about", robot, asked)


@pytest.mark.parametrize(
    ("say", "about", "otherwise"),
    [
        ("have all three boxes been checked by now?", "all three boxes", ""),
        ("did any of you check the gate?", "the gate", "did you check the gate?"),
        ("which boxes are left?", "", "what is left to do?"),
    ],
)
def test_whether_something_is_done_is_asked_of_the_work_and_else_of_the_robots(
    say: str, about: str, otherwise: str
) -> None:
    wish = team_wish(say, ROBOTS)
    assert wish is not None
    assert (wish.kind, wish.about, wish.otherwise.about if wish.otherwise else "") == (
        "progress",
        about,
        otherwise,
    )


def test_where_robots_shall_not_go_is_told_to_each_of_them() -> None:
    wish = team_wish("Ada and Kim must stay away from the gate", ROBOTS)
    assert wish is not None
    assert [(part.robot, part.order) for part in wish.parts] == [
        ("Ada", "you must not go into the gate"),
        ("Kim", "you must not go into the gate"),
    ]
    wish = team_wish("don't send Kim anywhere near the gate", ROBOTS)
    assert wish is not None
    assert [part.order for part in wish.parts] == ["you must not drive near the gate"]


def test_what_has_to_be_judged_is_offered_without_it() -> None:
    wish = team_wish("Ada checks the box, and once that's clear Kim goes to the gate", ROBOTS)
    assert wish is not None
    assert (wish.kind, wish.about) == ("judged", "Ada checks the box, then Kim goes to the gate")


def test_others_are_all_but_the_one_that_is_to_tell_them() -> None:
    wish = team_wish("tell the others to go to the gate", ROBOTS, "Ada")
    assert wish is not None
    assert [*wish.parts] == [Part("rest", "go to the gate", without=("Ada",))]


@pytest.mark.parametrize(
    "say", ["is anybody there?", "who are you?", "what are you doing, Kim?", "who is at the gate?"]
)
def test_other_questions_are_left_to_whoever_hears_them(say: str) -> None:
    assert team_wish(say, ROBOTS) is None


@pytest.mark.parametrize(
    ("say", "asked"),
    [
        ("Kim, where are you?", "where are you?"),
        ("hey Kim, how full is your battery?", "how full is your battery?"),
        ("Kim what can you do", "what can you do?"),
        ("What are you doing, Kim?", "What are you doing?"),
        ("Kim: what do you see?", "what do you see?"),
    ],
)
def test_a_question_is_for_whom_it_calls_whoever_hears_it(say: str, asked: str) -> None:
    wish = asked_by_name(say, ROBOTS, "Ada")
    assert wish is not None
    assert (wish.kind, wish.robot, wish.about) == ("about", "Kim", asked)
    assert asked_by_name(say, ROBOTS, "Kim") is None


@pytest.mark.parametrize(
    "say", ["Kim, go to the gate", "Kim, is the gate open?", "Ada and Kim, where are you?", "where are you?"]
)
def test_orders_and_questions_of_other_things_are_left_to_whoever_understands_them(say: str) -> None:
    assert asked_by_name(say, ROBOTS, "Ada") is None


@pytest.mark.parametrize(
    ("say", "read"),
    [
        ("half of you go to the gate", ""),
        ("make sure there is always one of you at the gate", ""),
        ("listen here, everybody go to the gate", "everybody go to the gate"),
        ("go to the gate, then to the desk", None),
        ("say hello to everybody", None),
        ("hm, well, one of you, share the work", ""),
    ],
)
def test_words_to_a_team_are_known_as_such_though_they_are_not_read(say: str, read: str | None) -> None:
    assert team_wish(say, ROBOTS) is None
    assert is_unread(say, ROBOTS) == read


@pytest.mark.parametrize(
    ("say", "asked"),
    [
        ("where are Ada and Kim?", {"Ada": "where are you?", "Kim": "where are you?"}),
        ("where are Kim and the box?", {"Kim": "where are you?", "Ada": "where are the box?"}),
        ("What are Ada and Kim doing?", {"Ada": "What are you doing?", "Kim": "What are you doing?"}),
        ("Are Kim and Ada done?", {"Kim": "Are you done?", "Ada": "Are you done?"}),
    ],
)
def test_what_is_asked_of_several_by_name_each_of_them_is_asked(say: str, asked: dict[str, str]) -> None:
    wish = team_wish(say, (*ROBOTS, "Leo"), "Ada")
    assert wish is not None
    assert wish.kind == "about"
    assert {part.robot: part.order for part in wish.parts} == asked


@pytest.mark.parametrize(
    ("say", "about"),
    [("who's stuck?", "what are you doing?"), ("who's got the least battery?", "how much battery is left?")],
)
def test_who_of_all_it_is_all_are_asked(say: str, about: str) -> None:
    wish = team_wish(say, ROBOTS, "Ada")
    assert wish is not None
    assert (wish.kind, wish.robot, wish.about) == ("about", "", about)


@pytest.mark.parametrize("say", ["what's Kim found?", "What has Kim found?"])
def test_what_one_has_done_it_is_asked_itself(say: str) -> None:
    wish = team_wish(say, ROBOTS, "Ada")
    assert wish is not None
    assert (wish.robot, wish.about.lower()) == ("Kim", "what have you found?")


@pytest.mark.parametrize(
    ("say", "parts"),
    [
        (
            "meet Kim at the gate",
            [Part("named", "go to the gate", "Ada"), Part("named", "go to the gate", "Kim")],
        ),
        ("let's all meet at the gate", [Part("all", "go to the gate")]),
        ("all of you, meet each other by the gate", [Part("all", "go to the gate")]),
    ],
)
def test_who_meets_goes_to_the_place(say: str, parts: list[Part]) -> None:
    wish = team_wish(say, ROBOTS, "Ada")
    assert wish is not None
    assert list(wish.parts) == parts
    assert gathered("Let's meet up at the gate") == "go to the gate"
    assert gathered("look at the gate") == "look at the gate"


@pytest.mark.parametrize(
    ("say", "work", "then"),
    [
        ("check all boxes between you and then meet at the gate", "check all boxes", "go to the gate"),
        ("Check the boxes, one each, then wait at the dock", "Check the boxes", "wait at the dock"),
        ("Split the boxes and check them. Then everybody goes to the dock", "check the boxes",
         "go to the dock"),
        ("Share the boxes, check each, and meet me at the gate when you're done", "check the boxes",
         "go to the gate"),
        ("Check all boxes between you. When you're done, all of you go to the dock", "Check all boxes",
         "go to the dock"),
        ("check the gate and the desk between you, then go back to the dock when you are all done",
         "check the gate and the desk", "go back to the dock"),
        ("check all boxes between you and look for keys", "check all boxes and look for keys", ""),
        ("check all boxes between you, then check the gate", "check all boxes, then check the gate", ""),
    ],
)  # fmt: skip
def test_where_all_are_behind_what_they_share_each_goes_itself(say: str, work: str, then: str) -> None:
    wish = team_wish(say, ROBOTS, "Ada")
    parts = [Part("all", work), *([Part("each", then, after=True)] if then else [])]
    assert (wish.kind, list(wish.parts)) == ("share", parts) if wish and work else wish is None


def test_who_is_let_go_does_what_was_said_before() -> None:
    for say in ("let Kim go", "No, let Kim do that"):
        wish = team_wish(say, ROBOTS, "Ada")
        assert wish is not None and wish.parts == (Part("named", "", "Kim"),)
        assert wish.parts[0].of_before
    assert gathered("check the boxes together") == "check the boxes"


@pytest.mark.parametrize(
    ("say", "turns", "parts"),
    [
        (
            "no wait, Ada to the dock and Kim to the gate",
            "done",
            [Part("named", "go to the dock", "Ada"), Part("named", "go to the gate", "Kim")],
        ),
        ("Stop! Ada go to the gate", "asked", [Part("named", "go to the gate", "Ada")]),
        ("hold on, all of you go back to the dock", "done", [Part("all", "go back to the dock")]),
        ("stop everyone, Kim goes to the gate", "asked", [Part("named", "go to the gate", "Kim")]),
        ("Freeze and go to the dock", "asked", [Part("named", "go to the dock", "Ada")]),
        ("Stop, everybody! Go to the dock", "asked", [Part("all", "Go to the dock")]),
    ],
)
def test_an_order_behind_words_of_stopping_is_read(say: str, turns: str, parts: list[Part]) -> None:
    wish = turned_wish(say, ROBOTS, ["Ada"])
    assert wish is not None
    assert (wish.turns, list(wish.parts)) == (turns, parts)


@pytest.mark.parametrize(
    "say",
    ["stop", "stop, there is a child", "stop, all of you", "wait, not that one",
     "wait, go to the gate instead", "Forget it, all of you wait at the dock",
     "one of you goes to the gate, the others wait at the dock", "wait at the dock", "stop, go on",
     "stop! Kim, stop", "wait a minute, then all of you go to the dock",
     "Ada goes to the gate", "hold the door"],
)  # fmt: skip
def test_what_is_no_order_behind_words_of_stopping_is_left_to_others(say: str) -> None:
    assert turned_wish(say, ROBOTS, ["Ada"]) is None


def test_behind_a_stop_all_that_hear_it_are_meant() -> None:
    wish = turned_wish("stop, go to the dock", (*ROBOTS, "Leo"), ROBOTS)
    assert wish is not None
    assert wish.parts == (Part("all", "go to the dock", without=("Leo",)),)


def test_you_is_whoever_hears_it() -> None:
    wish = team_wish("you go to the gate, Kim goes to the desk", ROBOTS, "Ada")
    assert wish is not None
    assert [part.robot for part in wish.parts] == ["Ada", "Kim"]
    assert team_wish("you go to the gate, Kim goes to the desk", ROBOTS) is None
