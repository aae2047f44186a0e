"""Every node of a syntax tree, for whoever looks for one kind of node only."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import fields, is_dataclass
from functools import cache
from typing import Any, TypeVar

from plcgen.plc.scl.syntax import Binary, Expression
from plcgen.plc.source import SourceText

Node = TypeVar("Node")


def walk(root: object) -> Iterator[object]:
    """The root and all below it, in the order of the text. Takes nodes and tuples of nodes; does not recurse."""
    waiting: list[Any] = [root]
    while waiting:
        node = waiting.pop()
        if type(node) is tuple:
            waiting.extend(reversed(node))
        elif parts := _parts(node.__class__):
            yield node
            waiting.extend([getattr(node, part) for part in parts])


@cache
def _parts(kind: Any) -> tuple[str, ...]:
    """Names of the fields of a node, last first; none for what is no node of the tree."""
    if not is_dataclass(kind) or kind is SourceText:
        return ()
    return tuple(field.name for field in reversed(fields(kind)))


def left_chain(node: Expression) -> tuple[Expression, list[Binary]]:
    """The leftmost operand of an expression, and the operators applied to it, in their order: a + b + c is a chain."""
    chain: list[Binary] = []
    while isinstance(node, Binary):
        chain.append(node)
        node = node.left
    return node, chain[::-1]


def find(root: object, kind: type[Node]) -> Iterator[Node]:
    return (node for node in walk(root) if isinstance(node, kind))
