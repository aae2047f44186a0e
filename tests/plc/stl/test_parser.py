"""The parser: files as Micro/WIN SMART exports them, and what they become."""

from __future__ import annotations

import pytest

from plcgen.plc.source import SourceText, Span, decode_source
from plcgen.plc.stl.operands import read_operand
from plcgen.plc.stl.parser import parse
from plcgen.plc.stl.syntax import (
    Address,
    AddressOf,
    Block,
    BlockKind,
    Constant,
    Indirect,
    Name,
    Operand,
    SectionKind,
)

EXPORT = """\
ORGANIZATION_BLOCK MAIN:OB1\r
TITLE=程序注释 // no comment\r
// 块注释\r
BEGIN\r
Network 1 \r
// 网络注释\r
LD     First_Scan_On\r
\tMOVW   +100, VW100 // größe\r
\tS      Q0.0, 1\r
\r
Network 2 // zweites Netzwerk\r
LD     Always_On\r
CALL   SBR_0, VW100, Speed\r
END_ORGANIZATION_BLOCK\r
SUBROUTINE_BLOCK SBR_0:SBR0\r
TITLE=\r
VAR_INPUT\r
EN:BOOL;\r
speed:REAL; // Hz\r
END_VAR\r
VAR_OUTPUT\r
Ergebnis : WORD;\r
END_VAR\r
BEGIN\r
END_SUBROUTINE_BLOCK\r
INTERRUPT_BLOCK INT_0:INT0\r
TITLE=INTERRUPT ROUTINE COMMENTS\r
BEGIN\r
Network 1\r
NETWORK 2\r
END_INTERRUPT_BLOCK\r
"""


def outline(block: Block) -> tuple[object, ...]:
    return block.kind, block.name, block.number, [len(network.statements) for network in block.networks]


@pytest.mark.parametrize("encoding", ["utf-8", "utf-8-sig", "gbk"])
@pytest.mark.parametrize("newline", ["\r\n", "\n"])
def test_export(encoding: str, newline: str) -> None:
    text = EXPORT.replace("\r\n", newline)
    text = text if encoding != "gbk" else text.replace("ö", "o").replace("ß", "s")
    source = decode_source("f.awl", text.encode(encoding))
    blocks = parse(source)
    assert [outline(block) for block in blocks] == [
        (BlockKind.ORGANIZATION, "MAIN", 1, [3, 2]),
        (BlockKind.SUBROUTINE, "SBR_0", 0, []),
        (BlockKind.INTERRUPT, "INT_0", 0, [0, 0]),
    ]
    move = blocks[0].networks[0].statements[1]
    assert (move.mnemonic, source.text[slice(*move.span)]) == ("MOVW", "MOVW   +100, VW100")
    assert [(item.section, item.name, item.type_name) for item in blocks[1].declarations] == [
        (SectionKind.INPUT, "EN", "BOOL"),
        (SectionKind.INPUT, "speed", "REAL"),
        (SectionKind.OUTPUT, "Ergebnis", "WORD"),
    ]


@pytest.mark.parametrize(("encoding", "name"), [("cp1252", "Größe"), ("gbk", "速度"), ("gbk", "運卄"), ("gbk", "速倕")])
def test_symbols_of_a_code_page(encoding: str, name: str) -> None:
    """Letters whose second byte is an ASCII character or a blank of Unicode."""
    text = f"ORGANIZATION_BLOCK MAIN:OB1\nBEGIN\nNetwork 1\nLD {name}\nEND_ORGANIZATION_BLOCK\n"
    (block,) = parse(decode_source("f.awl", text.encode(encoding)))
    (operand,) = block.networks[0].statements[0].operands
    assert isinstance(operand, Name)
    assert operand.text.encode("latin-1").decode(encoding) == name


@pytest.mark.parametrize(
    ("head", "name", "number"),
    [
        ("ORGANIZATION_BLOCK MAIN:OB1", "MAIN", 1),
        ("ORGANIZATION_BLOCK MAIN", "MAIN", None),
        ("ORGANIZATION_BLOCK", "", None),
        ("organization_block OB1", "OB1", 1),
        ("SUBROUTINE_BLOCK Start:SBR12", "Start", 12),
        ("SUBROUTINE_BLOCK Start : SBR12", "Start", 12),
        ("SUBROUTINE_BLOCK :SBR3", "", 3),
        ("SUBROUTINE_BLOCK SBR_3", "SBR_3", 3),
        ("SUBROUTINE_BLOCK Start", "Start", None),
        ("INTERRUPT_BLOCK INT0", "INT0", 0),
        ("PROGRAM_BLOCK MAIN:OB1", "MAIN", 1),
    ],
)
def test_heads(head: str, name: str, number: int | None) -> None:
    (block,) = parse(SourceText("f.awl", f"{head} // why\nBEGIN\nEND_{head.split()[0]}\n"))
    assert (block.name, block.number) == (name, number)


NOWHERE = Span(0, 0)


@pytest.mark.parametrize(
    ("text", "operand"),
    [
        ("V100.3", Address("V", "X", 100, 3, NOWHERE)),
        ("vb5", Address("V", "B", 5, 0, NOWHERE)),
        ("VW6", Address("V", "W", 6, 0, NOWHERE)),
        ("SMD72", Address("SM", "D", 72, 0, NOWHERE)),
        ("I0.0", Address("I", "X", 0, 0, NOWHERE)),
        ("QB1", Address("Q", "B", 1, 0, NOWHERE)),
        ("M31.7", Address("M", "X", 31, 7, NOWHERE)),
        ("S0.1", Address("S", "X", 0, 1, NOWHERE)),
        ("LW4", Address("L", "W", 4, 0, NOWHERE)),
        ("AIW16", Address("AI", "W", 16, 0, NOWHERE)),
        ("AQW32", Address("AQ", "W", 32, 0, NOWHERE)),
        ("AC3", Address("AC", "", 3, 0, NOWHERE)),
        ("T37", Address("T", "", 37, 0, NOWHERE)),
        ("C255", Address("C", "", 255, 0, NOWHERE)),
        ("+100", Constant(100, False, NOWHERE)),
        ("-5", Constant(-5, False, NOWHERE)),
        ("7", Constant(7, False, NOWHERE)),
        ("16#0F", Constant(15, True, NOWHERE)),
        ("2#1010_0101", Constant(165, True, NOWHERE)),
        ("75.0", Constant(75.0, False, NOWHERE)),
        ("-1.5E-3", Constant(-0.0015, False, NOWHERE)),
        ("2.", Constant(2.0, False, NOWHERE)),
        ("'A'", Constant(65, True, NOWHERE)),
        ("'ABCD'", Constant(0x41424344, True, NOWHERE)),
        ("Always_On", Name("Always_On", NOWHERE)),
        ('"two words"', Name("two words", NOWHERE)),
        ("VW", Name("VW", NOWHERE)),
        ("速度1", Name("速度1", NOWHERE)),
        ("SBR_0:SBR0", Name("SBR0", Span(6, 6))),
        ("Always_On:SM0.0", Address("SM", "X", 0, 0, Span(10, 15))),
    ],
)
def test_operands(text: str, operand: Operand) -> None:
    found = read_operand(SourceText("f.awl", text), Span(0, len(text)))
    assert type(found) is type(operand)
    assert {**vars(found), "span": None} == {**vars(operand), "span": None}


def test_pointers() -> None:
    source = SourceText("f.awl", "*AC1 &VB200")
    assert read_operand(source, Span(0, 4)) == Indirect(Address("AC", "", 1, 0, Span(1, 4)), Span(0, 4))
    assert read_operand(source, Span(5, 11)) == AddressOf(Address("V", "B", 200, 0, Span(6, 11)), Span(5, 11))


def test_comment_signs_in_quotes() -> None:
    text = "ORGANIZATION_BLOCK M:OB1\nBEGIN\nNetwork 1\nLDW= '//', VW0 // one, two\nEND_ORGANIZATION_BLOCK"
    (block,) = parse(SourceText("f.awl", text))
    assert [type(operand) for operand in block.networks[0].statements[0].operands] == [Constant, Address]


def test_title_inside_a_network_is_kept_for_the_import_rules() -> None:
    text = "ORGANIZATION_BLOCK M:OB1\nBEGIN\nNetwork 1\nTITLE = x\nLD I0.0\nEND_ORGANIZATION_BLOCK"
    (block,) = parse(SourceText("f.awl", text))
    assert len(block.networks[0].titles) == 1
    assert len(block.networks[0].statements) == 1
