"""The product does not know the story: with other words for everything, an equivalent story passes."""

from __future__ import annotations

import random
import re
import shutil
from importlib import resources
from pathlib import Path

import pytest

from parley.config import SystemConfig
from parley.demos.catalogue import load_demo
from parley.demos.runner import play

NOUNS = [
    "refrigerator", "fridge", "icebox", "sofa", "couch", "water", "bottle", "kitchen", "bedroom", "living",
    "dining", "table", "plant", "bookshelf", "bookcase", "TV", "tv", "television", "telly", "counter", "milk",
    "carton", "jam", "jar", "chair", "bed",
]  # fmt: skip
PEOPLE = ["John", "David"]


def _invented(rng: random.Random) -> str:
    """A word that no language has."""
    return "".join(rng.choice("bdfgklmprtvz") + rng.choice("aeiou") for _ in range(3)) + rng.choice("kmnrx")


def _renamed(folder: Path, seed: int) -> Path:
    """A copy of the demonstration in which every noun is another word, everywhere the same."""
    rng = random.Random(seed)
    words: dict[str, str] = {}
    for word in NOUNS:
        while (new := _invented(rng)) in words.values():
            pass
        words[word] = new
    words |= {name: _invented(rng).capitalize() for name in PEOPLE}
    shutil.copytree(resources.files("parley.demos") / "nursing_home", folder, dirs_exist_ok=True)  # type: ignore[arg-type]
    pattern = re.compile(
        r"(?<![a-zA-Z])(" + "|".join(sorted(words, key=len, reverse=True)) + r")(?![a-zA-Z])"
    )
    for name in ("world.yaml", "object_map.json", "story.yaml"):
        text = (folder / name).read_text(encoding="utf-8")
        (folder / name).write_text(pattern.sub(lambda found: words[found[0]], text), encoding="utf-8")
    return folder


@pytest.mark.parametrize("seed", range(4))
async def test_equivalent_story_in_invented_words_holds(tmp_path: Path, seed: int) -> None:
    demo = load_demo(str(_renamed(tmp_path / "world", seed)))
    assert "sofa" not in str(demo)
    config = SystemConfig(speed=None, data_dir=tmp_path / "data", seed=seed)
    result = await play(demo.story, lambda variant: demo.system(config, variant))
    assert result.held, result.text
