"""Who has to give way when it gets crowded."""

from __future__ import annotations

from parley.web.crowd import Crowd, Seat


class Hall:
    """Connections by name, and who had to leave."""

    def __init__(self, strangers: int = 4, known: int = 4) -> None:
        self.crowd = Crowd(strangers, known)
        self.left: list[str] = []

    def sit(self, name: str, address: str = "a") -> Seat:
        return self.crowd.sit(address, lambda: self.left.append(name))


def test_the_oldest_stranger_of_an_address_gives_way_to_its_newest() -> None:
    hall = Hall(strangers=4)
    for name in ("1", "2", "3"):
        hall.sit(name)
    assert hall.left == ["1"]


def test_the_most_crowded_address_gives_way_not_the_one_that_came_first() -> None:
    hall = Hall(strangers=3)
    hall.crowd = Crowd(5, 4)
    hall.sit("first", "b")
    for name in ("1", "2"):
        hall.sit(name)
    for name in ("3", "4"):
        hall.sit(name, "c")
    assert hall.left == []
    hall.sit("5", "d")
    assert hall.left == ["1"]


def test_who_is_known_stays_however_many_strangers_come() -> None:
    hall = Hall()
    hall.sit("Ada").known("Ada")
    for number in range(1000):
        hall.sit(f"{number}", f"{number % 7}")
    assert "Ada" not in hall.left
    assert len(hall.left) == 996


def test_one_person_has_at_most_half_of_the_places_of_those_who_are_known() -> None:
    hall = Hall(known=4)
    hall.sit("Kim").known("Kim")
    for name in ("1", "2", "3"):
        hall.sit(name).known("Ada")
    assert hall.left == ["1"]


def test_who_left_takes_no_place() -> None:
    hall = Hall(strangers=4)
    seat = hall.sit("1")
    seat.known("Ada")
    seat.free()
    seat.free()
    for _ in range(2):
        hall.sit("2").free()
    hall.sit("3")
    hall.sit("4")
    assert hall.left == []


def test_somebody_gives_way_when_there_is_no_room_at_all() -> None:
    hall = Hall()
    hall.crowd.shed()
    hall.sit("1")
    hall.crowd.shed()
    assert hall.left == ["1"]
