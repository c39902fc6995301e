"""What people say about remembering itself."""

from __future__ import annotations

import pytest

from parley.memory.sayings import (
    Viewing,
    asks_for_all,
    asks_how_known,
    asks_to_see,
    file_title,
    for_oneself,
    keeping_action,
    picture_name,
)
from parley.messages.status import ActionInfo


@pytest.mark.parametrize(
    ("message", "name"),
    [
        ("This is my desk.", "desk"),
        ("this is the loading dock", "loading dock"),
        ("Look, that's our new cart!", "new cart"),
        ("Here is a picture of the back gate", "back gate"),
        ("Remember this as the spare key", "spare key"),
        ("This is called Bay 12, please", "Bay 12"),
        ("The picture shows my bench. It is old.", "bench"),
        ("what is this?", ""),
        ("Is this my desk?", ""),
        ("go to the dock", ""),
        ("this is it", ""),
        ("", ""),
        ("this is " + "very " * 60 + "long", ""),
    ],
)
def test_name_of_a_picture_is_read_from_the_words_that_came_with_it(message: str, name: str) -> None:
    assert picture_name(message) == name


@pytest.mark.parametrize(
    ("answer", "name"),
    [("my desk", "desk"), ("The dock.", "dock"), ("dock", "dock"), ("it's the dock", "dock")],
)
def test_answer_may_be_the_bare_name(answer: str, name: str) -> None:
    assert picture_name(answer, bare=True) == name


@pytest.mark.parametrize(
    ("file", "title"),
    [
        ("loading_dock.jpg", "loading dock"),
        ("C:\\pictures\\my desk.png", "my desk"),
        ("IMG_1234.jpg", ""),
        ("image.png", ""),
        ("20261121_100401.jpg", ""),
        ("", ""),
        ("x.jpg", ""),
    ],
)
def test_file_names_count_only_where_a_person_gave_them(file: str, title: str) -> None:
    assert file_title(file) == title


@pytest.mark.parametrize(
    ("message", "wish"),
    [
        ("What did I show you?", Viewing("list")),
        ("which pictures do you have", Viewing("list")),
        ("show me the picture of the desk", Viewing("picture", "the desk")),
        ("Please show me that photo of my desk again.", Viewing("picture", "my desk")),
        ("Could you show me my photo of the dock, please?", Viewing("picture", "the dock")),
        ("show me the picture", Viewing("picture")),
        ("show me my desk", Viewing("maybe", "my desk")),
        ("go to the desk", None),
        ("what did I tell you?", None),
    ],
)
def test_wishes_to_see_pictures_are_told_from_other_messages(message: str, wish: Viewing | None) -> None:
    assert asks_to_see(message) == wish


@pytest.mark.parametrize(
    "message", ["How do you know?", "how do you know that", "Who told you?", "says who?"]
)
def test_asking_where_something_is_known_from(message: str) -> None:
    assert asks_how_known(message)


@pytest.mark.parametrize("message", ["How do you know the way to the dock?", "do you know Kim?", ""])
def test_other_questions_about_knowing_are_not_meant(message: str) -> None:
    assert not asks_how_known(message)


@pytest.mark.parametrize(
    "message",
    [
        "What do you remember?",
        "tell me everything you know",
        "What have I told you so far?",
        "list your memories",
    ],
)
def test_asking_for_everything_that_is_remembered(message: str) -> None:
    assert asks_for_all(message)
    assert not asks_for_all(f"{message.rstrip('?')} about the dock?")


SNAP = ActionInfo(
    name="Snap", inputs={"name": "string"}, optional=("name",), effects=("remembers",),
    phrases=("keep the picture", "keep {name}"),
)  # fmt: skip


@pytest.mark.parametrize(
    ("message", "info", "name"),
    [
        ("Keep the picture, please.", SNAP, "Snap"),
        ("keep the picture of the dock", SNAP, ""),
        ("keep {name}", SNAP.model_copy(update={"optional": ()}), ""),
        ("keep the picture", SNAP.model_copy(update={"effects": ("looks",)}), ""),
    ],
)
def test_order_to_keep_what_is_seen_is_recognised_whole(message: str, info: ActionInfo, name: str) -> None:
    assert keeping_action(message, [info]) == name


@pytest.mark.parametrize(
    ("message", "rest"),
    [
        ("Remember for yourself that the dock is blue", "Remember that the dock is blue"),
        ("remember just for you: the dock is blue", "remember: the dock is blue"),
        ("remember that the dock is blue", ""),
        ("fetch it for yourself", ""),
    ],
)
def test_remembering_for_oneself_is_told_from_remembering_for_all(message: str, rest: str) -> None:
    assert for_oneself(message) == rest
