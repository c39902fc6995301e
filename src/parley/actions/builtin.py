"""The list of built-in actions."""

from __future__ import annotations

from parley.actions.ask_operator import ask_operator
from parley.actions.dock import dock
from parley.actions.follow import follow
from parley.actions.get_coordinates import get_coordinates
from parley.actions.inspect import inspect
from parley.actions.keep_picture import keep_picture
from parley.actions.move_by import move_by
from parley.actions.navigate_to import navigate_to
from parley.actions.pick_up import pick_up
from parley.actions.place import place
from parley.actions.say import say
from parley.actions.take_picture import take_picture
from parley.actions.turn_by import turn_by
from parley.actions.wait import wait
from parley.actions.wait_for_robot import wait_for_robot
from parley.umrf.action import ActionSpec

__all__ = ["BUILTIN_ACTIONS"]

BUILTIN_ACTIONS: tuple[ActionSpec, ...] = tuple(
    action.spec
    for action in (
        get_coordinates,
        navigate_to,
        inspect,
        ask_operator,
        keep_picture,
        move_by,
        turn_by,
        take_picture,
        wait,
        wait_for_robot,
        say,
        follow,
        dock,
        pick_up,
        place,
    )
)
