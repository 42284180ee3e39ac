"""Policies as ONNX graphs, for a controller on a robot. Needs the extra `onnx`."""

from __future__ import annotations

import json
import os
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
import onnx
from onnx import TensorProto, helper, numpy_helper

from policies.learned import files
from policies.learned.description import Description, Normalisation
from policies.learned.pretrained import locate
from slipgym import atomic_io

OPSET, IR_VERSION = 17, 8
"""Of 2022, so that runtimes on robots know them."""


def write_onnx(policy: str | os.PathLike[str], path: str | os.PathLike[str]) -> None:
    """Writes a policy as an ONNX file, in place of one that may be there.

    Input `observation` (n, m) float32, as it comes from the environment; output `action` (n, k) float32
    within [-1, 1]. Normalisation (in float64, as in training) and clipping are part of the graph. LSTM
    layers add inputs `hidden` and `cell` (n, layers, size), zero where an episode begins, and outputs
    `next_hidden` and `next_cell`.
    The metadata `policy` is policy.json: columns, units, what -1 and +1 mean.
    A policy that comes with slipgym goes by its name.

    Raises:
        FileNotFoundError: There is no policy.
        OSError: The file cannot be written.
        ValueError: What lies there is none, or not whole.
    """
    atomic_io.check_file(Path(path))
    model = graph_of(*files.read(locate(policy)))
    onnx.checker.check_model(model, full_check=True)
    with atomic_io.new_file(Path(path)) as file:
        file.write_bytes(model.SerializeToString(deterministic=True))


def graph_of(description: Description, tensors: dict[str, np.ndarray]) -> onnx.ModelProto:
    """The graph of a policy, from what `files.read` returns."""
    graph, acts = _Graph(), len(description.environment.action)
    inputs, outputs = [("observation", (description.environment.width,))], [("action", (acts,))]
    x, network = "observation", description.network
    if description.normalisation is not None:
        x = _normalised(graph, x, description.normalisation, tensors)
    if network.memory is not None:
        shape = (network.memory.layers, network.memory.size)
        inputs += [("hidden", shape), ("cell", shape)]
        outputs += [("next_hidden", shape), ("next_cell", shape)]
        x = _remembered(graph, x, network.memory.layers, tensors)
    for k in range(len(network.layers) + 1):
        x = graph.dense(x, f"layers.{k}.", tensors)
        if k < len(network.layers):
            x = graph.add({"tanh": "Tanh", "relu": "Relu", "elu": "Elu"}[network.activation], [x])
    ends = graph.scalar(-1.0), graph.scalar(1.0)
    bounded = ("Tanh", [x]) if network.squash else ("Clip", [x, *ends])
    graph.add(*bounded, output="action")
    model = helper.make_model(
        helper.make_graph(graph.nodes, "policy", _values(inputs), _values(outputs), graph.constants),
        opset_imports=[helper.make_opsetid("", OPSET)],
        ir_version=IR_VERSION,
        producer_name="slipgym",
    )
    said = description.model_dump(mode="json", exclude_unset=True)
    helper.set_model_props(model, {"policy": json.dumps(said)})
    return model


class _Graph:
    """Nodes and constants as they are added."""

    def __init__(self) -> None:
        self.nodes: list[onnx.NodeProto] = []
        self.constants: list[onnx.TensorProto] = []

    def constant(self, name: str, value: np.ndarray) -> str:
        self.constants.append(numpy_helper.from_array(value, name))
        return name

    def scalar(self, value: float, kind: type = np.float32) -> str:
        return self.constant(f"scalar_{len(self.constants)}", np.array(value, kind))

    def add(self, operator: str, inputs: Sequence[str], output: str = "", **attributes: Any) -> str:
        """Adds a node with one output; returns the output's name."""
        output = output or f"value_{len(self.nodes)}"
        self.nodes.append(helper.make_node(operator, inputs, [output], **attributes))
        return output

    def dense(self, x: str, prefix: str, tensors: dict[str, np.ndarray]) -> str:
        names = (f"{prefix}{kind}" for kind in ("weight", "bias"))
        return self.add("Gemm", [x, *(self.constant(name, tensors[name]) for name in names)], transB=1)

    def split(self, x: str, parts: int) -> list[str]:
        """Adds a split into equal parts along the columns."""
        names = [f"value_{len(self.nodes)}_{k}" for k in range(parts)]
        self.nodes.append(helper.make_node("Split", [x], names, axis=1))
        return names


def _normalised(graph: _Graph, x: str, given: Normalisation, tensors: dict[str, np.ndarray]) -> str:
    scale = np.sqrt(tensors["observation.var"] + given.epsilon)
    x = graph.add("Cast", [x], to=TensorProto.DOUBLE)
    x = graph.add("Sub", [x, graph.constant("observation.mean", tensors["observation.mean"])])
    x = graph.add("Div", [x, graph.constant("observation.scale", scale)])
    x = graph.add("Clip", [x, graph.scalar(-given.clip, np.float64), graph.scalar(given.clip, np.float64)])
    return graph.add("Cast", [x], to=TensorProto.FLOAT)


def _remembered(graph: _Graph, x: str, layers: int, tensors: dict[str, np.ndarray]) -> str:
    """The LSTM layers, one step; the operator LSTM would want its weights in another order."""
    axis, kept = graph.constant("layer_axis", np.array([1])), {"hidden": [], "cell": []}
    for k in range(layers):
        at = graph.constant(f"layer_{k}", np.array(k))
        hidden, cell = (graph.add("Gather", [name, at], axis=1) for name in kept)
        gates = []
        for part, value in (("input", x), ("hidden", hidden)):
            gates.append(graph.dense(value, f"memory.{k}.{part}_", tensors))
        enter, forget, candidate, leave = graph.split(graph.add("Add", gates), 4)
        old = graph.add("Mul", [graph.add("Sigmoid", [forget]), cell])
        new = graph.add("Mul", [graph.add("Sigmoid", [enter]), graph.add("Tanh", [candidate])])
        cell = graph.add("Add", [old, new])
        x = graph.add("Mul", [graph.add("Sigmoid", [leave]), graph.add("Tanh", [cell])])
        for name, value in (("hidden", x), ("cell", cell)):
            kept[name].append(graph.add("Unsqueeze", [value, axis]))
    for name, values in kept.items():
        graph.add("Concat", values, output=f"next_{name}", axis=1)
    return x


def _values(shapes: Sequence[tuple[str, tuple[int, ...]]]) -> list[onnx.ValueInfoProto]:
    """Inputs or outputs, with a leading batch axis."""
    return [helper.make_tensor_value_info(name, TensorProto.FLOAT, ["n", *shape]) for name, shape in shapes]
