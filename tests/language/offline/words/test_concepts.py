"""Words that stand for the same deed or thing."""

from parley.language.offline.words.concepts import concepts, contrary, likeness, opposed, other_verbs
from parley.language.offline.words.naming import kind_of, name_words


def test_names_in_any_style_become_words() -> None:
    assert name_words("navGoal") == ("navigate", "goal")
    assert name_words("pick-obj") == ("pick", "object")
    assert name_words("goto_pose") == ("go", "to", "pose")


def test_types_are_known_by_their_other_names() -> None:
    assert [kind_of(kind) for kind in ("float", "int", "str", "number", "Costmap")] == [
        "number", "number", "string", "number", "Costmap",
    ]  # fmt: skip


def test_a_verb_is_found_with_its_particle_behind_what_it_acts_on() -> None:
    assert "turn off" in {concept.text for concept in concepts(("turn", "the", "siren", "off"))}


def test_words_of_one_line_are_alike_and_others_are_not() -> None:
    (honk,), (sound,), (paint,) = (concepts((word,)) for word in ("honk", "sound", "paint"))

    assert likeness(honk, sound) > 0
    assert likeness(honk, paint) == 0


def test_a_word_within_a_longer_phrase_does_not_count_alone() -> None:
    said = concepts(("end", "the", "call"))
    assert [(concept.text, concept.within) for concept in said] == [("end the call", False), ("call", True)]


def test_the_contrary_of_what_is_said_is_told_apart() -> None:
    (on,) = concepts(("on",))

    assert opposed(on, concepts(("siren", "off")))
    assert contrary(("back", "up"), ("straight", "ahead"))


def test_orders_may_begin_with_other_words_for_a_deed() -> None:
    assert ("crack", "a", "joke") in other_verbs(("tell", "joke"))


def test_near_words_are_less_alike_than_those_that_may_stand_for_each_other() -> None:
    (orbit,), (circle,) = concepts(("orbit",)), concepts(("circle",))
    (close,), (shut,) = concepts(("close",)), concepts(("shut",))
    assert 0.7 <= likeness(orbit, circle) < likeness(close, shut) < 1


def test_a_particle_before_to_belongs_to_where_somebody_goes() -> None:
    assert "go up" not in {one.text for one in concepts(("go", "up", "to", "the", "attic"))}
