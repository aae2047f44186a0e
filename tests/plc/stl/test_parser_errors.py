"""What parser and lowering say about bad STL, word for word, and that they never answer in any other way."""

from __future__ import annotations

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from plcgen.errors import Fault, SourceError
from plcgen.plc.cpu.smart import Smart
from plcgen.plc.source import SourceText, decode_source
from plcgen.plc.stl.lowering import lower
from plcgen.plc.stl.parser import parse
from plcgen.plc.stl.smart_table import MNEMONICS


def message(text: str) -> str:
    with pytest.raises(SourceError) as caught:
        lower(parse(SourceText("f.awl", text)))
    return str(caught.value).split("\n")[0]


FILES = [
    (
        "LD I0.0",
        "f.awl:1:1: a block expected, found LD; blocks begin with ORGANIZATION_BLOCK, SUBROUTINE_BLOCK or"
        " INTERRUPT_BLOCK",
    ),
    (
        "ORGANISATION_BLOCK MAIN:OB1",
        "f.awl:1:1: a block expected, found ORGANISATION_BLOCK; did you mean ORGANIZATION_BLOCK?; blocks begin with"
        " ORGANIZATION_BLOCK, SUBROUTINE_BLOCK or INTERRUPT_BLOCK",
    ),
    (
        "ORGANIZATION_BLOCK MAIN:OB1\nNetwork 1",
        "f.awl:2:1: BEGIN expected, found NETWORK; it stands between the declarations and the networks",
    ),
    (
        "ORGANIZATION_BLOCK MAIN:OB1\nBEGIN\nLD I0.0",
        "f.awl:3:1: Network expected, found LD; write Network 1 above it",
    ),
    (
        "ORGANIZATION_BLOCK MAIN:OB1\nBEGIN\nNetwork 1\nLD I0.0",
        "f.awl:4:8: END_ORGANIZATION_BLOCK expected, found end of file; it closes ORGANIZATION_BLOCK of line 1",
    ),
    (
        "SUBROUTINE_BLOCK a:SBR0\nBEGIN\nEND_INTERRUPT_BLOCK",
        "f.awl:3:1: END_SUBROUTINE_BLOCK expected, found END_INTERRUPT_BLOCK; it closes SUBROUTINE_BLOCK of line 1",
    ),
    ("SUBROUTINE_BLOCK a:INT0\nBEGIN", "f.awl:1:1: INT0 is no SBR; write SUBROUTINE_BLOCK a:SBR0"),
    (
        "SUBROUTINE_BLOCK two words:SBR0\nBEGIN",
        "f.awl:1:1: the name of a block has no blanks; write it like MAIN:OB1",
    ),
    (
        "SUBROUTINE_BLOCK a:SBR0\nVAR_INPUT\nx REAL;\nEND_VAR",
        "f.awl:3:1: a declaration such as speed : REAL; expected, found x REAL;; END_VAR closes VAR_INPUT of line 2",
    ),
    (
        "SUBROUTINE_BLOCK a:SBR0\nVAR_INPUT\nx : LREAL;\nEND_VAR\nBEGIN\nEND_SUBROUTINE_BLOCK",
        "f.awl:3:1: type LREAL is not supported; local variables are BOOL, BYTE, WORD, INT, DWORD, DINT, REAL",
    ),
    (
        "SUBROUTINE_BLOCK a:SBR0\nVAR\nx : INT;\nX : REAL;\nEND_VAR\nBEGIN\nEND_SUBROUTINE_BLOCK",
        "f.awl:4:1: X is declared twice; rename one",
    ),
    (
        "SUBROUTINE_BLOCK a:SBR0\nVAR\n" + "".join(f"x{n} : REAL;\n" for n in range(17)) + "END_VAR\nBEGIN\n"
        "END_SUBROUTINE_BLOCK",
        "f.awl:19:1: local variables take more than the 64 bytes of L; use V memory",
    ),
    (
        "SUBROUTINE_BLOCK a:SBR0\nBEGIN\nEND_SUBROUTINE_BLOCK\nSUBROUTINE_BLOCK b:SBR0\nBEGIN\nEND_SUBROUTINE_BLOCK",
        "f.awl:4:1: SBR0 stands in f.awl:1:1 too; give one of them another number",
    ),
]


@pytest.mark.parametrize(("text", "expected"), FILES)
def test_files(text: str, expected: str) -> None:
    assert message(text) == expected


STATEMENTS = [
    ("LD I0.0,", "1:9: an operand is missing here; remove the comma or write one"),
    ("LD ,I0.0", "1:4: an operand is missing here; remove the comma or write one"),
    ("LD 'A", "1:4: quote is not closed on this line; add one"),
    (
        "LD 5x",
        "1:4: 5x is no operand; write an address such as VD100, a constant such as +5, 16#0F or 7.5, or a symbol",
    ),
    ("MOVE VW0, VW2", "1:1: unknown mnemonic MOVE; did you mean MOVW?"),
    ("HSC 0", "1:1: HSC is not supported here; no program with it can be executed"),
    ("LD", "1:1: LD takes 1 operand, 0 are given"),
    ("LD I0.0, I0.1", "1:1: LD takes 1 operand, 2 are given"),
    ("EU I0.0", "1:1: EU takes no operands, 1 are given"),
    ("A I0.0", "1:1: A needs a condition before it in its network; begin with LD"),
    ("LD I0.0\nALD", "2:1: ALD needs 2 levels of the logic stack, there is 1; add an LD"),
    ("LD I0.0\nLPP", "2:1: LPP needs 2 levels of the logic stack, there is 1; add an LD"),
    ("MOVW +1, VW0", "1:1: MOVW needs a condition before it in its network; begin with LD"),
    ("LD I0.0\nLDS 1", "2:1: LDS needs 2 levels of the logic stack, there is 1; add an LD"),
    ("LD I0.0\nLDS 32", "2:5: 32 is no level of the logic stack; write a constant from 0 to 31"),
    ("LD I0.0\n" * 32 + "LD I0.0", "33:1: the logic stack has 32 levels; split the network"),
    ("LD VB0", "1:4: VB0 is a byte, a bit is wanted here"),
    ("LD AC0", "1:4: AC0 is an accumulator, a bit is wanted here"),
    ("LD V0.8", "1:4: V0.8: bit 8 does not exist; a byte has bits 0 to 7"),
    ("LD I40.0", "1:4: I40.0 lies outside the 32 bytes of I"),
    ("LD Always_Onn", "1:4: unknown symbol Always_Onn; did you mean Always_On?"),
    ("LD Motor", "1:4: unknown symbol Motor; write its address"),
    ("LD *AC1", "1:4: *AC1: a bit cannot be reached by a pointer; move its byte"),
    ("LD SM0.0\n= SM0.1", "2:3: SM0.1: SMB0 belongs to the CPU and cannot be written"),
    ("LD SM0.0\n= 1", "2:3: 1 cannot be written; name an address"),
    ("LD SM0.0\n=I V0.0", "2:1: =I takes outputs only; write =, or an address of Q"),
    ("LD SM0.0\nMOVW VD0, VW4", "2:6: VD0 is a double word, a word is wanted here"),
    ("LD SM0.0\nMOVB 256, VB0", "2:6: 256 is no BYTE; MOVB takes 0 to 255"),
    ("LD SM0.0\nMOVB -1, VB0", "2:6: -1 is no BYTE; MOVB takes 0 to 255"),
    ("LD SM0.0\nMOVW +32768, VW0", "2:6: +32768 is no INT; MOVW takes -32768 to 32767"),
    ("LD SM0.0\nMOVW 16#10000, VW0", "2:6: 16#10000 is no INT; MOVW takes 0 to 65535"),
    ("LD SM0.0\nMOVD 1.5, VD0", "2:6: 1.5 is a REAL, MOVD takes DINT; write a whole number"),
    ("LD SM0.0\nMOVR 1, VD0", "2:6: 1 is no REAL; write it with a point, like 1.0"),
    ("LD SM0.0\nMOVD &V0.0, AC1", "2:6: &V0.0: a pointer points to a byte; write &VB0"),
    ("LD SM0.0\nMOVD &LB0, AC1", "2:6: &LB0: a pointer cannot point to L; point to V memory"),
    ("LD SM0.0\nMOVD &AC1, AC1", "2:6: &AC1: a pointer cannot point to an accumulator; point to V memory"),
    ("LD SM0.0\nMOVW &VB0, VW4", "2:6: &VB0 is a double word; MOVD takes it"),
    ("LD SM0.0\nMOVB *AC0, VB0", "2:6: AC0 cannot hold a pointer; use VD, LD, AC1, AC2 or AC3"),
    ("LD SM0.0\nMOVB *MD4, VB0", "2:6: MD4 cannot hold a pointer; use VD, LD, AC1, AC2 or AC3"),
    ("LD SM0.0\nMOVW AIW3, VW0", "2:6: AIW3: analog words have even numbers"),
    ("LD SM0.0\nMOVW AC4, VW0", "2:6: AC4 does not exist; there are AC0 to AC3"),
    ("LD SM0.0\nMOVW T256, VW0", "2:6: T256 does not exist; T255 is the last"),
    ("LD SM0.0\nMOVD T37, VD0", "2:6: T37 is a word or a bit, a double word is wanted here"),
    ("LD SM0.0\nBMB 5, VB0, 3", "2:5: 5 is no block of memory; name its first address"),
    ("LD SM0.0\nBMB VB0, MB30, 3", "2:16: N = 3 does not fit here; write a constant from 1 to 2"),
    ("LD SM0.0\nFILL +0, VW0, 0", "2:15: N = 0 does not fit here; write a constant from 1 to 255"),
    ("LD SM0.0\nTON C5, +1", "2:5: C5 is no timer; write T0 to T255"),
    ("LD SM0.0\nTON T1, +1", "2:1: T1 is a timer for TONR; TON and TOF have T32 to T63 and T96 to T255"),
    ("LD SM0.0\nTONR T37, +1", "2:1: T37 is a timer for TON or TOF; TONR has T0 to T31 and T64 to T95"),
    ("LD SM0.0\nCTU C1, +1", "2:1: CTU needs 2 levels of the logic stack, there is 1; add an LD"),
    ("LD SM0.0\nJMP 4", "2:1: no LBL 4 in MAIN; a jump stays in its block"),
    ("NEXT", "1:1: NEXT without FOR; write FOR above it"),
    ("LD SM0.0\nFOR VW0, +1, +2", "2:1: FOR without NEXT; write NEXT in a network of its own"),
    ("LSCR S0.0", "1:1: LSCR without SCRE; write SCRE in a network of its own"),
    ("LSCR S0.0\nLSCR S0.1", "2:1: LSCR inside a step; write SCRE above it"),
    ("LD SM0.0\nSCRT S0.0", "2:1: SCRT outside a step; write LSCR above it"),
    ("SCRE", "1:1: SCRE outside a step; write LSCR above it"),
    ("LD SM0.0\nSHRB I0.0, M31.7, 2", "2:1: N = 2 reaches beyond the end of M; write fewer"),
    ("LBL 1\nLBL 1", "2:1: LBL 1 stands twice in MAIN; give one another number"),
    ("LD SM0.0\nCALL", "2:1: CALL of what? write the name of a subroutine"),
    ("LD SM0.0\nCALL Strat", "2:6: no subroutine Strat; did you mean Start?"),
    ("LD SM0.0\nCALL Start", "2:1: Start has 2 parameters, 0 are given; write speed REAL, done BOOL"),
    ("LD SM0.0\nCALL Start, VW0, V0.0", "2:13: VW0 is a word, a double word is wanted here"),
    ("LD SM0.0\nCALL Start, VD0, 1", "2:18: 1 cannot be written; name an address"),
    ("LD SM0.0\nATCH Tock, 10", "2:6: no interrupt routine Tock; did you mean Tick?"),
    ("LD SM0.0\nATCH Tick, 45", "2:12: 45 is no interrupt event; write a constant from 0 to 44"),
    ("LD SM0.0\nPLS 3", "2:5: 3 is no pulse output; write a constant from 0 to 2"),
    ("LD SM0.0\nPLS VB0", "2:5: VB0 is no pulse output; write a constant from 0 to 2"),
]
OTHERS = """
SUBROUTINE_BLOCK Start:SBR0
VAR_INPUT
speed : REAL;
END_VAR
VAR_OUTPUT
done : BOOL;
END_VAR
BEGIN
END_SUBROUTINE_BLOCK
INTERRUPT_BLOCK Tick:INT0
BEGIN
END_INTERRUPT_BLOCK
"""
HEAD = "ORGANIZATION_BLOCK MAIN:OB1\nBEGIN\nNetwork 1\n"


@pytest.mark.parametrize(("text", "expected"), STATEMENTS)
def test_statements(text: str, expected: str) -> None:
    row, rest = expected.split(":", 1)
    found = message(f"{HEAD}{text}\nEND_ORGANIZATION_BLOCK{OTHERS}")
    assert found == f"f.awl:{int(row) + 3}:{rest}"


def test_local_of_another_size() -> None:
    text = (
        "SUBROUTINE_BLOCK a:SBR0\nVAR\nx : INT;\nEND_VAR\nBEGIN\nNetwork 1\nLD SM0.0\nMOVD x, VD0\nEND_SUBROUTINE_BLOCK"
    )
    assert message(text) == "f.awl:8:6: x is INT, MOVD takes DINT"


def test_too_many_edges() -> None:
    body = "LD I0.0\n" + "EU\n" * 1025
    assert message(f"{HEAD}{body}END_ORGANIZATION_BLOCK") == (
        "f.awl:1029:1: more than 1024 EU and ED in the program; use fewer"
    )


def test_the_caret_stands_under_the_operand_whatever_the_tabs() -> None:
    with pytest.raises(SourceError) as caught:
        lower(parse(SourceText("f.awl", f"{HEAD}\tLD     SM0.0\r\n\tMOVW   VD0,\tVW4\r\nEND_ORGANIZATION_BLOCK\r\n")))
    assert str(caught.value) == (
        "f.awl:5:9: VD0 is a double word, a word is wanted here\n    MOVW   VD0,\tVW4\n           ^^^"
    )


WORDS = st.sampled_from([*MNEMONICS, "NETWORK 1", "BEGIN", "END_VAR", "VAR", "TITLE=", "END_ORGANIZATION_BLOCK"])


def _lengths(word: str) -> tuple[int, int]:
    """How many operands the instruction takes, at least and at most."""
    slots = MNEMONICS[word].slots
    return (1, 3) if slots is None else (len(slots), len(slots))


OPERANDS = st.sampled_from(
    [
        "VW0",
        "VD4",
        "V0.0",
        "*AC1",
        "&VB5",
        "+5",
        "16#FF",
        "1.5",
        "T37",
        "C1",
        "AC1",
        "*VD0",
        "VB3",
        "Q0.5",
        "x",
        "SBR0",
        "'A'",
        "I0.0",
        "LB63",
        "9",
    ]
)
STATEMENTS_OF_A_TABLE = st.sampled_from(sorted(MNEMONICS)).flatmap(
    lambda word: st.tuples(st.just(word), st.lists(OPERANDS, min_size=_lengths(word)[0], max_size=_lengths(word)[1]))
)
LINES = (STATEMENTS_OF_A_TABLE | st.tuples(WORDS, st.lists(OPERANDS, max_size=4))).map(
    lambda pair: f"{pair[0]} {', '.join(pair[1])}"
)


@settings(max_examples=500, deadline=None, suppress_health_check=[HealthCheck.too_slow])
@given(st.lists(LINES, max_size=12))
def test_any_lines_are_executed_or_refused(lines: list[str]) -> None:
    text = HEAD + "LD I0.0\n" + "\n".join(lines) + "\nEND_ORGANIZATION_BLOCK" + OTHERS
    try:
        machine = Smart(lower(parse(SourceText("f.awl", text))))
    except SourceError as error:
        assert error.location is not None
        return
    machine.memory["V"][:16] = bytes.fromhex("08001FF0 42280000 FFFFFFFF 7F800001")
    try:
        machine.run_until(20_000)
    except Fault as fault:
        assert fault.location is not None


@settings(deadline=None)
@given(st.binary(max_size=200))
def test_any_bytes_are_parsed_or_refused(data: bytes) -> None:
    try:
        parse(decode_source("f.awl", HEAD.encode() + data))
    except SourceError as error:
        assert error.location is not None
