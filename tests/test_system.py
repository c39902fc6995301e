"""Opening and closing everything: nothing is left behind, whatever happens."""

from __future__ import annotations

import asyncio
import threading
from pathlib import Path

import pytest

from parley.config import EmbeddingSettings, SystemConfig
from parley.demos.catalogue import load_demo
from parley.errors import StoreError
from parley.memory.embedding_server import EmbeddingServer
from parley.memory.meanings import GONE
from parley.umrf.threads import IDLE
from parley.world.object_map import MapObject, ObjectMap
from tests.demos.house import running


def others() -> set[asyncio.Task[object]]:
    return {task for task in asyncio.all_tasks() if task is not asyncio.current_task()}


async def test_closing_in_the_middle_of_a_drive_leaves_no_task_and_no_thread(tmp_path: Path) -> None:
    before = {thread.name for thread in threading.enumerate()}
    config = SystemConfig(speed=1.0, data_dir=tmp_path)
    async with running(load_demo("nursing-home").system(config)) as home:
        await home.say("go to the fridge")
        await home.state("running")
    assert others() == set()
    kept = ("asyncio_", IDLE)  # for what comes next
    left = {thread.name for thread in threading.enumerate() if not thread.name.startswith(kept)} - before
    assert left == set()


async def test_closing_while_a_question_is_open_leaves_nothing(tmp_path: Path) -> None:
    async with running(load_demo("nursing-home").system(SystemConfig(speed=None))) as home:
        await home.say("There is a water bottle in the fridge")
        await home.say("John is on the sofa")
        await home.say("John is thirsty, get him water")
        await home.question()
    assert others() == set()


async def test_opening_that_fails_closes_what_was_opened(tmp_path: Path) -> None:
    (tmp_path / "memory.db").mkdir()
    system = load_demo("nursing-home").system(SystemConfig(data_dir=tmp_path))
    with pytest.raises(StoreError, match="memory"):
        async with system:
            pass
    assert others() == set()


async def test_damaged_memory_file_is_told_to_whoever_comes(tmp_path: Path) -> None:
    (tmp_path / "memory.db").write_bytes(b"this is no database\n" * 500)
    config = SystemConfig(speed=None, data_dir=tmp_path)
    async with running(load_demo("nursing-home").system(config)) as home:
        await home.observer.until(lambda: any("damaged" in said.message for said in home.observer.said))
        (told,) = [said for said in home.observer.said if "damaged" in said.message]
        assert (told.type, told.targets) == ("error", home.system.robot_names)
        assert "memory.db.corrupt-" in told.message


async def test_embedding_server_that_is_gone_is_told_once_and_words_still_find(tmp_path: Path) -> None:
    with EmbeddingServer() as server:
        server.status = 503
        settings = EmbeddingSettings(url=server.address, model="words")
        config = SystemConfig(speed=None, embeddings=settings)
        async with running(load_demo("nursing-home").system(config)) as home:
            await home.say("The key is in the drawer.")
            await home.observer.until(lambda: any(said.message == GONE for said in home.observer.said))
            reply = await home.say("Where is the key?")
            assert "drawer" in reply.message
            assert [said.message for said in home.observer.said].count(GONE) == 1
    assert others() == set()


async def test_unreadable_record_of_stops_means_that_everybody_is_stopped_and_is_told(tmp_path: Path) -> None:
    (tmp_path / "stops.json").write_text("{", encoding="utf-8")
    config = SystemConfig(speed=None, data_dir=tmp_path)
    async with running(load_demo("nursing-home").system(config)) as home:
        await home.observer.until(
            lambda: any("count as stopped" in item.message for item in home.observer.said)
        )
        assert all(home.system.stop_line.latched(name) for name in home.system.robot_names)
        assert all(home.system.simulator.stopped(name) for name in home.system.robot_names)


async def test_a_robot_asks_before_it_drives_past_somebody_whom_the_map_knows(tmp_path: Path) -> None:
    system = load_demo("nursing-home").system(SystemConfig(data_dir=tmp_path, approval="ask_when_risky"))
    async with running(system) as home:
        (robot,) = system.robots.values()
        somebody = MapObject("1", "Ada", robot.pose().x_m, robot.pose().y_m, "person")
        system.engines.objects = ObjectMap((*system.objects.objects, somebody))
        system.engines.tell_sites()
        said = await home.say("go to the fridge")
        assert "Somebody stands in the way" in said.message
