"""The parts of a message are cut once for each wording, and never kept for longer than they hold."""

from __future__ import annotations

import pytest

from parley.evaluation.catalogues import CATALOGUES
from parley.language.base import Situation
from parley.language.offline.readings import parts
from parley.language.offline.readings.parts import Parts
from parley.language.offline.scene.scene import Scene
from parley.language.offline.sentences.units import units
from parley.language.offline.words.text import Phrase, plain, tokens
from parley.messages.status import ActionInfo
from parley.world.object_map import MapObject

POND = MapObject(id="pond", description="pond", class_name="pond", x_m=1.0, y_m=2.0)
GATE = MapObject(id="gate", description="gate", class_name="gate", x_m=5.0, y_m=2.0)
SHUTTERS = ActionInfo(name="lower_shutters", description="Lowers the shutters.")


def parts_of(*objects: MapObject, actions: tuple[ActionInfo, ...] = CATALOGUES["thesis"]) -> Parts:
    return Parts(Scene.of(Situation(message="", objects=objects, catalogue=actions)))


def test_each_wording_is_cut_once(monkeypatch: pytest.MonkeyPatch) -> None:
    cut: list[str] = []

    def counted(words: Phrase, *rest: object) -> object:
        cut.append(plain(words))
        return units(words, *rest)  # type: ignore[arg-type]

    monkeypatch.setattr(parts, "units", counted)
    message = parts_of(POND)
    first = message.of(tokens("Check the pond, the ducks are loud"))
    assert message.of(tokens("Check the pond, the ducks are loud")) == first
    assert [unit.kind for unit in first] == ["order", "told"]
    message.of(tokens("check the pond"))
    assert cut == ["Check the pond, the ducks are loud", "check the pond"]


def test_the_same_words_have_other_parts_on_another_map() -> None:
    said = tokens("the pond, then the gate")
    assert [plain(name) for unit in parts_of(POND, GATE).of(said) for name in unit.names] == [
        "the pond",
        "the gate",
    ]
    assert [plain(name) for unit in parts_of(GATE).of(said) for name in unit.names] == ["the gate"]


def test_what_an_action_explains_is_an_order() -> None:
    said = tokens("shutters down")
    assert [unit.kind for unit in parts_of(POND).of(said)] != ["order"]
    assert [unit.kind for unit in parts_of(POND, actions=(SHUTTERS,)).of(said)] == ["order"]
