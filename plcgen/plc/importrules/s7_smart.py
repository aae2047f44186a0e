"""What Micro/WIN SMART refuses, drops without a word or reads differently when it imports an .awl file."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from plcgen.plc.importrules import smart_networks, smart_text
from plcgen.plc.importrules.finding import Finding, Rule
from plcgen.plc.importrules.smart_subject import SmartSubject
from plcgen.plc.source import SourceText
from plcgen.plc.stl.lowering import NO_SYMBOLS
from plcgen.plc.stl.lowering_names import Names
from plcgen.plc.stl.syntax import Block

RULES: tuple[Rule[SmartSubject], ...] = (
    Rule("byte-order-mark", "error", smart_text.no_byte_order_mark),
    Rule("encoding", "warning", smart_text.plain_ascii),
    Rule("line-end", "warning", smart_text.crlf),
    Rule("head", "error", smart_text.head),
    Rule("one-block", "warning", smart_text.one_block),
    Rule("block-order", "warning", smart_text.block_order),
    Rule("identifier-length", "error", smart_text.identifier_length),
    Rule("local-variable", "warning", smart_text.local_variables),
    Rule("nesting-depth", "error", smart_text.nesting_depth),
    Rule("title", "error", smart_networks.title_inside),
    Rule("mnemonic", "error", smart_networks.known_mnemonic),
    Rule("symbol", "error", smart_networks.known_symbol),
    Rule("constant-sign", "warning", smart_networks.constant_sign),
    Rule("place", "error", smart_networks.right_block),
    Rule("stand-alone", "error", smart_networks.stands_alone),
    Rule("one-rung", "error", smart_networks.one_rung),
    Rule("logic-stack", "error", smart_networks.logic_stack),
    Rule("loop", "error", smart_networks.loops),
    Rule("label", "error", smart_networks.labels),
)


def findings(
    source: SourceText,
    blocks: tuple[Block, ...],
    program: Sequence[Block] = (),
    symbols: Mapping[str, str] = NO_SYMBOLS,
) -> list[Finding]:
    """Every breach in the order of the text; `program` are the blocks of all files together, if there are more."""
    subject = SmartSubject(source, blocks, Names(program or blocks, symbols))
    found = [finding for rule in RULES for finding in rule.findings(subject)]
    return sorted(found, key=lambda finding: (finding.location.line, finding.location.column))
