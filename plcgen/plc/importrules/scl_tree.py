"""Rules about what an SCL source says: names, order of blocks, and what a compiler lacks."""

from __future__ import annotations

import re
from collections.abc import Iterator

from plcgen.plc.importrules.finding import Hit, Subject
from plcgen.plc.scl.syntax import (
    Address,
    Argument,
    ArraySpec,
    Assignment,
    Binary,
    Block,
    Call,
    Constant,
    Declaration,
    Expression,
    Literal,
    Member,
    NamedType,
    Region,
    Scope,
    Unary,
    Variable,
)
from plcgen.plc.scl.walk import find
from plcgen.plc.source import Span

# ---------------------------------------------------------------------------------------------------------- names


def identifier_length(subject: Subject) -> Iterator[Hit]:
    longest = subject.dialect.identifier_length
    for name, span in _declared_names(subject):
        if len(name) > longest:
            yield span, f"{name} has {len(name)} characters; {subject.dialect.title} allows {longest}, shorten it"


def _declared_names(subject: Subject) -> Iterator[tuple[str, Span]]:
    for block in subject.blocks:
        yield block.name, block.span
        yield from ((constant.name, constant.span) for constant in block.constants)
        yield from ((item.name, item.span) for item in find((block.sections, block.structure), Declaration))


def quoted_name(subject: Subject) -> Iterator[Hit]:
    """One warning for each name, at its first place."""
    seen: set[str] = set()
    for name, span in _quoted_names(subject):
        if name.upper() not in seen:
            yield span, f'"{name}" must stand in the symbol table before this source is compiled'
        seen.add(name.upper())


def _quoted_names(subject: Subject) -> Iterator[tuple[str, Span]]:
    for block in subject.blocks:
        if block.quoted:
            yield block.name, block.span
        for item in find(block, Variable):
            if item.scope is Scope.GLOBAL:
                yield item.name, item.span


def local_prefix(subject: Subject) -> Iterator[Hit]:
    for block in subject.blocks:
        names = _local_names(block)
        for item in find(block.body, Variable):
            if item.scope is Scope.PLAIN and item.name.upper() in names:
                yield _name_span(item), f"local {item.name} without #; write #{item.name}"


def no_local_prefix(subject: Subject) -> Iterator[Hit]:
    for item in find(subject.blocks, Variable):
        if item.scope is Scope.LOCAL:
            yield _name_span(item), f"# before a name is TIA spelling; write {item.name}"


def _local_names(block: Block) -> set[str]:
    """Of a DB none: its initial values are written without #."""
    declared = [item.name for section in block.sections for item in section.declarations]
    return {name.upper() for name in (*declared, *(constant.name for constant in block.constants))}


def _name_span(item: Variable) -> Span:
    return Span(item.span.start, item.selectors[0].span.start if item.selectors else item.span.end)


# ---------------------------------------------------------------------------------------------------------- order


def block_order(subject: Subject) -> Iterator[Hit]:
    """The compiler reads once, from top to bottom: what a block names must stand above it."""
    places = {block.name.upper(): index for index, block in enumerate(subject.blocks)}
    for index, block in enumerate(subject.blocks):
        seen: set[str] = set()
        for name, span in _uses(block):
            later = places.get(name.upper(), -1)
            if later > index and name.upper() not in seen:
                line = subject.source.location(subject.blocks[later].span).line
                yield span, f"{name} is used above its own place in line {line}; move it before {block.name}"
            seen.add(name.upper())


def _uses(block: Block) -> Iterator[tuple[str, Span]]:
    if block.instance_of:
        yield block.instance_of, block.span
    yield from ((item.name, item.span) for item in find(block, NamedType))
    yield from ((item.area, item.span) for item in find(block, Address))
    names = _local_names(block)
    for item in find(block.body, Variable):
        if item.scope is Scope.GLOBAL or (item.scope is Scope.PLAIN and item.name.upper() not in names):
            yield item.name, item.span
    for call in find(block.body, Call):
        yield from ((part.name, part.span) for part in call.callee.selectors if isinstance(part, Member))


# ------------------------------------------------------------------------------------------------ language extent


def region(subject: Subject) -> Iterator[Hit]:
    for item in find(subject.blocks, Region):
        yield item.span, "REGION needs S7-1200 or S7-1500; write a comment line"


def compound_assignment(subject: Subject) -> Iterator[Hit]:
    for item in find(subject.blocks, Assignment):
        if item.operator:
            yield item.span, f"{item.operator}= needs S7-1200 or S7-1500; write x := x {item.operator} ..."


def output_arrow(subject: Subject) -> Iterator[Hit]:
    for item in find(subject.blocks, Argument):
        if item.is_output:
            yield item.span, f"=> does not exist in STEP 7 V5; read {item.name} from the instance behind the call"


def absent_function(subject: Subject) -> Iterator[Hit]:
    for call in find(subject.blocks, Call):
        word = call.callee.name.upper()
        if call.callee.scope is Scope.PLAIN and word in subject.dialect.absent:
            yield call.callee.span, _absent(subject, word)
    for item in find(subject.blocks, Binary):
        if item.operator in subject.dialect.absent:
            yield item.operator_span, _absent(subject, item.operator)


def _absent(subject: Subject, word: str) -> str:
    return f"{word} does not exist in {subject.dialect.title}; write {subject.dialect.absent[word]}"


def real_point(subject: Subject) -> Iterator[Hit]:
    for item in find(subject.blocks, Literal):
        text = subject.text(item.span)
        better = re.sub(r"([0-9])[eE]", r"\1.0E", text)
        if isinstance(item.value, float) and "." not in text and better != text:
            yield item.span, f"REAL literal {text} needs a point in {subject.dialect.title}; write {better}"


def real_equality(subject: Subject) -> Iterator[Hit]:
    for block in subject.blocks:
        reals = _real_names(block)
        for item in find(block.body, Binary):
            if item.operator in ("=", "<>") and (_is_real(item.left, reals) or _is_real(item.right, reals)):
                yield item.operator_span, f"REAL compared with {item.operator}, which rounding decides; compare a range"


def _real_names(block: Block) -> set[str]:
    declared = [item for section in block.sections for item in section.declarations]
    reals = {item.name.upper() for item in declared if _is_real_type(item)}
    return reals | {item.name.upper() for item in block.constants if _is_real_constant(item)}


def _is_real_type(item: Declaration) -> bool:
    spec = item.type.element if isinstance(item.type, ArraySpec) else item.type
    return isinstance(spec, NamedType) and spec.name in ("REAL", "LREAL")


def _is_real_constant(item: Constant) -> bool:
    return isinstance(item.value, Literal) and isinstance(item.value.value, float)


def _is_real(item: Expression, reals: set[str]) -> bool:
    """As far as the text of one block tells; a member of another block is not looked up."""
    if isinstance(item, Literal):
        return isinstance(item.value, float)
    if isinstance(item, Variable):
        return item.name.upper() in reals and not any(isinstance(part, Member) for part in item.selectors)
    if isinstance(item, Unary):
        return _is_real(item.operand, reals)
    if isinstance(item, Binary) and item.operator in ("+", "-", "*", "/"):
        return _is_real(item.left, reals) or _is_real(item.right, reals)
    return False
