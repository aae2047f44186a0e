"""What STEP 7 V5 and TIA refuse, drop or read differently when they import an SCL source: two tables of rules."""

from __future__ import annotations

from collections.abc import Mapping

from plcgen.plc.importrules import scl_text, scl_tree
from plcgen.plc.importrules.finding import Finding, Rule, Subject
from plcgen.plc.scl.dialects import CLASSIC, TIA, Dialect
from plcgen.plc.scl.syntax import Block
from plcgen.plc.source import SourceText

RULES: Mapping[str, tuple[Rule[Subject], ...]] = {
    CLASSIC.name: (
        Rule("byte-order-mark", "error", scl_text.no_byte_order_mark),
        Rule("encoding", "error", scl_text.one_byte_characters),
        Rule("code-page", "warning", scl_text.plain_ascii),
        Rule("line-end", "error", scl_text.crlf),
        Rule("line-length", "error", scl_text.line_length),
        Rule("nested-comment", "error", scl_text.nested_comment),
        Rule("header-quotes", "error", scl_text.header_quotes),
        Rule("header-word", "error", scl_text.header_words),
        Rule("identifier-length", "error", scl_tree.identifier_length),
        Rule("quoted-name", "warning", scl_tree.quoted_name),
        Rule("local-prefix", "error", scl_tree.no_local_prefix),
        Rule("block-order", "error", scl_tree.block_order),
        Rule("region", "error", scl_tree.region),
        Rule("compound-assignment", "error", scl_tree.compound_assignment),
        Rule("output-arrow", "error", scl_tree.output_arrow),
        Rule("real-equality", "warning", scl_tree.real_equality),
    ),
    TIA.name: (
        Rule("byte-order-mark", "warning", scl_text.byte_order_mark),
        Rule("encoding", "error", scl_text.utf8),
        Rule("line-end", "warning", scl_text.crlf),
        Rule("header-quotes", "error", scl_text.bare_version),
        Rule("title-quotes", "warning", scl_text.bare_title),
        Rule("identifier-length", "error", scl_tree.identifier_length),
        Rule("local-prefix", "warning", scl_tree.local_prefix),
        Rule("absent-function", "error", scl_tree.absent_function),
        Rule("real-point", "error", scl_tree.real_point),
        Rule("region", "warning", scl_tree.region),
        Rule("compound-assignment", "warning", scl_tree.compound_assignment),
        Rule("real-equality", "warning", scl_tree.real_equality),
    ),
}


def findings(source: SourceText, blocks: tuple[Block, ...], dialect: Dialect) -> list[Finding]:
    """Every breach in the order of the text. `dialect` is the one to import as; empty when the import is clean."""
    subject = Subject(source, blocks, dialect)
    found = [finding for rule in RULES[dialect.name] for finding in rule.findings(subject)]
    return sorted(found, key=lambda finding: (finding.location.line, finding.location.column))
