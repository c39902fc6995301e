"""Other languages are told by their small words, with accents or without; English is never taken for one."""

from __future__ import annotations

import pytest

from parley.language.offline.words.foreign import is_foreign
from parley.language.offline.words.text import tokens


@pytest.mark.parametrize(
    "said",
    [
        "Peux-tu regarder si le four est éteint ?",
        "peux tu regarder si le four est eteint",
        "Könntest du nachsehen, ob die Tür offen ist?",
        "Koenntest du nachsehen ob die Tuer offen ist",
        "¿Podrías ver si la puerta está cerrada?",
        "Puoi controllare la finestra?",
        "Pode ir até a cozinha?",
        "Kun je naar de keuken gaan?",
        "Czy możesz iść do kuchni?",
        "Kan du gå til køkkenet?",
        "Voisitko mennä keittiöön?",
        "Kas sa saaksid kööki minna?",
        "Mutfağa gidebilir misin?",
        "Можешь поехать на склад?",
    ],
)
def test_another_language_is_told(said: str) -> None:
    assert is_foreign(tokens(said))


@pytest.mark.parametrize(
    "said",
    [
        "Go to the café and look for Jan de Boer",
        "Die Hard is on at nine, man",
        "drive to the kiosk, por favor",
        "Is the El Dorado suite free?",
        "coud you hav a lok at the ovn",
    ],
)
def test_english_stays_english(said: str) -> None:
    assert not is_foreign(tokens(said))


def test_names_of_the_map_are_no_foreign_words() -> None:
    said = tokens("Küche und Bad")
    assert is_foreign(said)
    assert not is_foreign(said, frozenset({"küche", "und", "bad"}))
