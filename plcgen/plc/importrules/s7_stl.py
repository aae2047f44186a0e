"""What STEP 7 V5 refuses, or reads differently, when it compiles an STL source."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass

from plcgen.plc.importrules import scl_text, scl_tree
from plcgen.plc.importrules.finding import Finding, Hit, Rule, Subject
from plcgen.plc.scl.syntax import (
    ArraySpec,
    BlockKind,
    Declaration,
    Literal,
    NamedType,
    TypeSpec,
)
from plcgen.plc.scl.syntax import Scope as Spelling
from plcgen.plc.scl.walk import find
from plcgen.plc.source import SourceText, Span
from plcgen.plc.stl.s7_constants import REAL_DIGITS
from plcgen.plc.stl.s7_language import STL
from plcgen.plc.stl.s7_syntax import Block, BlockName, Constant, LabelName, Operand, Variable
from plcgen.plc.types import DINT, REAL

LABEL_LENGTH = 4


@dataclass(frozen=True)
class StlSubject(Subject):
    """A parsed source; `blocks` are what it declares, `coded` the same blocks with their statements."""

    coded: tuple[Block, ...] = ()

    def operands(self) -> Iterator[Operand]:
        for block in self.coded:
            for statement in block.statements:
                yield from statement.operands
                yield from (argument.operand for argument in statement.arguments)


# ----------------------------------------------------------------------------------------------------------- labels


def label_length(subject: StlSubject) -> Iterator[Hit]:
    for block in subject.coded:
        for statement in block.statements:
            label = statement.label
            if label is not None and len(label.name) > LABEL_LENGTH:
                yield label.span, _long_label(label)


def _long_label(label: LabelName) -> str:
    return f"label {label.name} has {len(label.name)} characters; {LABEL_LENGTH} are the most, shorten it"


def missing_network(subject: StlSubject) -> Iterator[Hit]:
    for block in subject.coded:
        if block.statements and (not block.networks or block.networks[0].start > block.statements[0].span.start):
            yield block.statements[0].span, "instruction above the first NETWORK; write NETWORK behind BEGIN"


# ----------------------------------------------------------------------------------------------------------- header

_VERSION = re.compile(r"[0-9]{1,2}\.[0-9]{1,2}")


def version_form(subject: StlSubject) -> Iterator[Hit]:
    for block in subject.coded:
        version = block.declaration.header.version
        if version is not None and not _VERSION.fullmatch(version):
            yield block.declaration.span, f"VERSION {version} of {block.name} is none; write VERSION : 0.1"


# -------------------------------------------------------------------------------------------------------- constants


def real_spelling(subject: StlSubject) -> Iterator[Hit]:
    for operand in subject.operands():
        if isinstance(operand, Constant) and operand.kind is REAL:
            yield from _real(subject, operand.span)
    for literal in find(subject.blocks, Literal):
        if isinstance(literal.value, float):
            yield from _real(subject, literal.span)


def _real(subject: StlSubject, span: Span) -> Iterator[Hit]:
    text = subject.text(span)
    if not REAL_DIGITS.fullmatch(text.replace(" ", "")):
        yield span, f"REAL {text} needs a point with digits on both sides; write {_pointed(text)}"


def _pointed(text: str) -> str:
    return re.sub(r"^([+-]?[0-9_]+)(?=[eE]|$)", r"\1.0", text)


def double_prefix(subject: StlSubject) -> Iterator[Hit]:
    """A DINT begins with L#; without, STEP 7 takes the number for an INT."""
    for item in find(subject.blocks, Declaration):
        if _is_named(item.type, DINT.name):
            for literal in find(item.initial, Literal):
                yield from _double(subject, literal)
    yield from _values_of_data_blocks(subject)


def _values_of_data_blocks(subject: StlSubject) -> Iterator[Hit]:
    doubles = _double_members(subject)
    for block in subject.blocks:
        owner = (block.instance_of or block.name).casefold() if block.kind is BlockKind.DB else ""
        for statement in block.body:
            target, value = getattr(statement, "target", None), getattr(statement, "value", None)
            if target is not None and (owner, getattr(target, "name", "").casefold()) in doubles:
                yield from (hit for literal in find(value, Literal) for hit in _double(subject, literal))


def _double_members(subject: StlSubject) -> set[tuple[str, str]]:
    """(block, member) for each DINT on the first level."""
    members: set[tuple[str, str]] = set()
    for block in subject.blocks:
        own = [item for section in block.sections for item in section.declarations]
        own += block.structure.fields if block.structure else ()
        members |= {(block.name.casefold(), item.name.casefold()) for item in own if _is_named(item.type, DINT.name)}
    return members


def _double(subject: StlSubject, literal: Literal) -> Iterator[Hit]:
    if isinstance(literal.value, int) and not isinstance(literal.value, bool) and literal.type_name is None:
        text = subject.text(literal.span)
        yield literal.span, f"{text} is an INT here; write L#{text}"


def _is_named(spec: TypeSpec, name: str) -> bool:
    inner = spec.element if isinstance(spec, ArraySpec) else spec
    return isinstance(inner, NamedType) and inner.name == name


# ------------------------------------------------------------------------------------------------------------ names


def quoted_name(subject: StlSubject) -> Iterator[Hit]:
    """One warning for each name, at its first place."""
    seen: set[str] = set()
    for name, span in _quoted(subject):
        if name.upper() not in seen:
            yield span, f'"{name}" must stand in the symbol table before this source is compiled'
        seen.add(name.upper())


def _quoted(subject: StlSubject) -> Iterator[tuple[str, Span]]:
    for block in subject.blocks:
        if block.quoted:
            yield block.name, block.span
    for operand in subject.operands():
        if isinstance(operand, Variable) and operand.scope is Spelling.GLOBAL:
            yield operand.name, operand.span


def block_order(subject: StlSubject) -> Iterator[Hit]:
    """The compiler reads once: what a block declares with or calls must stand above it."""
    places = {block.name.upper(): number for number, block in enumerate(subject.blocks)}
    for number, block in enumerate(subject.coded):
        seen: set[str] = set()
        for name, span in _uses(block):
            later = places.get(name.upper(), -1)
            if later > number and name.upper() not in seen:
                line = subject.source.location(subject.blocks[later].span).line
                yield span, f"{name} is used above its own place in line {line}; move it before {block.name}"
            seen.add(name.upper())


def _uses(block: Block) -> Iterator[tuple[str, Span]]:
    declaration = block.declaration
    if declaration.instance_of:
        yield declaration.instance_of, declaration.span
    yield from ((item.name, item.span) for item in find((declaration.sections, declaration.structure), NamedType))
    for statement in block.statements:
        for operand in statement.operands:
            if isinstance(operand, BlockName) or (isinstance(operand, Variable) and operand.scope is Spelling.GLOBAL):
                yield operand.name, operand.span


# ------------------------------------------------------------------------------------------------------ data blocks


def missing_begin(subject: StlSubject) -> Iterator[Hit]:
    for block in subject.blocks:
        text = subject.text(block.extent)
        if block.kind is BlockKind.DB and not re.search(r"(?im)^\s*BEGIN\b", text):
            yield block.span, f"{block.name} has no BEGIN; write it above END_DATA_BLOCK"


def real_equality(subject: StlSubject) -> Iterator[Hit]:
    for block in subject.coded:
        for statement in block.statements:
            if statement.mnemonic in ("==R", "<>R"):
                yield statement.span, f"REAL compared with {statement.word}, which rounding decides; compare a range"


RULES: tuple[Rule[StlSubject], ...] = (
    Rule("byte-order-mark", "error", scl_text.no_byte_order_mark),
    Rule("encoding", "error", scl_text.one_byte_characters),
    Rule("code-page", "warning", scl_text.plain_ascii),
    Rule("line-end", "error", scl_text.crlf),
    Rule("line-length", "error", scl_text.line_length),
    Rule("header-quotes", "error", scl_text.bare_version),
    Rule("title-quotes", "warning", scl_text.bare_title),
    Rule("header-word", "error", scl_text.header_words),
    Rule("version", "error", version_form),
    Rule("identifier-length", "error", scl_tree.identifier_length),
    Rule("label-length", "error", label_length),
    Rule("network", "error", missing_network),
    Rule("begin", "error", missing_begin),
    Rule("real-point", "error", real_spelling),
    Rule("double-prefix", "error", double_prefix),
    Rule("block-order", "error", block_order),
    Rule("quoted-name", "warning", quoted_name),
    Rule("real-equality", "warning", real_equality),
)


def findings(source: SourceText, blocks: tuple[Block, ...]) -> list[Finding]:
    """Every breach in the order of the text; empty when the import is clean."""
    declared = tuple(block.declaration for block in blocks)
    subject = StlSubject(source, declared, STL, blocks)
    found = [finding for rule in RULES for finding in rule.findings(subject)]
    return sorted(found, key=lambda finding: (finding.location.line, finding.location.column))
