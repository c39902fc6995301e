"""The tagger as it is trained: MiniLM (BERT with six layers) and heads over the first piece of each word."""

from __future__ import annotations

import json
import struct
from typing import cast

import torch
from torch import Tensor, nn

from parley.language.builtin.labels import DESCRIBED, HEADS

__all__ = ["WIDTH", "Tagger", "load_base", "load_shipped"]

WIDTH = 384
_LAYERS = 6
_ATTENTION_HEADS = 12
_INNER = 1536
_PIECES = 30522
_PLACES = 512
_ARC = 96


class _Layer(nn.Module):
    def __init__(self) -> None:
        super().__init__()
        self.query, self.key, self.value, self.out = (nn.Linear(WIDTH, WIDTH) for _ in range(4))
        self.norm = nn.LayerNorm(WIDTH, eps=1e-12)
        self.up, self.down = nn.Linear(WIDTH, _INNER), nn.Linear(_INNER, WIDTH)
        self.last = nn.LayerNorm(WIDTH, eps=1e-12)
        self.dropout = nn.Dropout(0.1)

    def forward(self, x: Tensor, hidden: Tensor) -> Tensor:
        batch, length, _ = x.shape
        shape = (batch, length, _ATTENTION_HEADS, WIDTH // _ATTENTION_HEADS)
        q, k, v = (part(x).view(shape).transpose(1, 2) for part in (self.query, self.key, self.value))
        scores = q @ k.transpose(-1, -2) / (WIDTH // _ATTENTION_HEADS) ** 0.5
        mixed = self.dropout(torch.softmax(scores + hidden, -1)) @ v
        x = self.norm(x + self.dropout(self.out(mixed.transpose(1, 2).reshape(batch, length, WIDTH))))
        return cast(Tensor, self.last(x + self.dropout(self.down(nn.functional.gelu(self.up(x))))))


class Tagger(nn.Module):
    """The encoder with its heads."""

    def __init__(self) -> None:
        super().__init__()
        self.pieces = nn.Embedding(_PIECES, WIDTH)
        self.places = nn.Embedding(_PLACES, WIDTH)
        self.kind = nn.Parameter(torch.zeros(WIDTH))
        self.norm = nn.LayerNorm(WIDTH, eps=1e-12)
        self.layers = nn.ModuleList(_Layer() for _ in range(_LAYERS))
        self.dropout = nn.Dropout(0.1)
        self.heads = nn.ModuleDict({name: nn.Linear(WIDTH, size) for name, size in HEADS.items()})
        self.arc_from, self.arc_to = nn.Linear(WIDTH, _ARC), nn.Linear(WIDTH, _ARC)
        self.arc_none = nn.Linear(WIDTH, 1)
        self.described = nn.Linear(WIDTH, len(DESCRIBED))

    def forward(self, ids: Tensor, mask: Tensor, first: Tensor) -> tuple[Tensor, ...]:
        """Scores of heads and arcs for each word (column 0: none), of frames for the whole; its meaning."""
        places = torch.arange(ids.shape[1], device=ids.device)
        x = self.dropout(self.norm(self.pieces(ids) + self.places(places) + self.kind))
        hidden = (1.0 - mask)[:, None, None, :] * -1e4
        for layer in self.layers:
            x = layer(x, hidden)
        words = torch.gather(x, 1, first[:, :, None].expand(-1, -1, WIDTH))
        tags = [head(self.dropout(words)) for head in self.heads.values()]
        arcs = self.arc_from(words) @ self.arc_to(words).transpose(1, 2) / _ARC**0.5
        arcs = torch.cat([self.arc_none(words), arcs], -1)
        pooled = (x * mask[:, :, None]).sum(1) / mask.sum(1, keepdim=True)
        return (*tags, arcs, self.described(self.dropout(pooled)), pooled)


def load_base(model: Tagger, weights: bytes) -> None:
    """Put the published weights (safetensors) into the encoder."""
    size = struct.unpack("<Q", weights[:8])[0]
    table = json.loads(weights[8 : 8 + size])

    def tensor(name: str) -> Tensor:
        entry = table[name]
        start, end = (8 + size + offset for offset in entry["data_offsets"])
        return (
            torch.frombuffer(bytearray(weights[start:end]), dtype=torch.float32).view(entry["shape"]).clone()
        )

    with torch.no_grad():
        model.pieces.weight.copy_(tensor("embeddings.word_embeddings.weight"))
        model.places.weight.copy_(tensor("embeddings.position_embeddings.weight"))
        model.kind.copy_(tensor("embeddings.token_type_embeddings.weight")[0])
        _copy(model.norm, tensor, "embeddings.LayerNorm")
        for number, layer in enumerate(model.layers):
            for part, name in _PARTS.items():
                _copy(getattr(layer, part), tensor, f"encoder.layer.{number}.{name}")


def load_shipped(model: Tagger, weights: bytes) -> None:
    """Put the weights of a tagger.onnx, as far as its bytes tell, into a model that has the base model's."""
    import onnx

    graph = onnx.load_model_from_string(weights).graph
    values = {one.name: onnx.numpy_helper.to_array(one) for one in graph.initializer}
    own = dict(model.named_parameters())
    with torch.no_grad():
        for name, parameter in own.items():
            if name in values:
                parameter.copy_(torch.from_numpy(values[name].copy()))
        for node in graph.node:
            if node.op_type == "MatMulInteger":
                stem = node.input[1].removesuffix("_quantized")
                whole = values[node.input[1]].astype("float32") - values[f"{stem}_zero_point"].astype(
                    "float32"
                )
                name = node.name.strip("/").split("/MatMul")[0].split("/Gemm")[0].replace("/", ".")
                name = f"heads.{name}" if name in HEADS else name
                own[f"{name}.weight"].copy_(torch.from_numpy((whole * values[f"{stem}_scale"]).T.copy()))


_PARTS = {
    "query": "attention.self.query", "key": "attention.self.key", "value": "attention.self.value",
    "out": "attention.output.dense", "norm": "attention.output.LayerNorm",
    "up": "intermediate.dense", "down": "output.dense", "last": "output.LayerNorm",
}  # fmt: skip


def _copy(module: nn.Module, tensor: object, name: str) -> None:
    for kind in ("weight", "bias"):
        getattr(module, kind).copy_(tensor(f"{name}.{kind}"))  # type: ignore[operator]
