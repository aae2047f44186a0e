"""Import rules of Micro/WIN SMART: what each rejects, word for word, and that a clean file passes."""

from __future__ import annotations

import pytest

from plcgen.plc.importrules.s7_smart import RULES, findings
from plcgen.plc.source import decode_source
from plcgen.plc.stl.parser import parse

CLEAN = """\
ORGANIZATION_BLOCK MAIN:OB1
TITLE=Example
BEGIN
Network 1 // several boxes after one LD
LD     First_Scan_On
MOVB   50, Time_0_Intrvl
MOVW   +100, VW0
ATCH   INT_0, 10
ENI
Network 2 // branches of one rung
LD     I0.0
LPS
LD     I0.1
O      I0.2
ALD
=      Q0.0
LRD
A      I0.3
=      Q0.1
LPP
LD     I0.4
ON     I0.5
ALD
=      Q0.2
Network 3
LD     I0.0
LD     I0.1
CTU    C1, +5
Network 4
LD     SM0.0
FOR    VW2, +1, +3
Network 5
LD     SM0.0
INCW   VW4
Network 6
NEXT
Network 7
LD     I0.0
JMP    1
Network 8
LBL    1
Network 9
LD     I0.0
END
END_ORGANIZATION_BLOCK
"""
INTERRUPT = "INTERRUPT_BLOCK INT_0:INT0\nBEGIN\nNetwork 1\nLD     SM0.0\nCRETI\nEND_INTERRUPT_BLOCK\n"
LEFT_OUT = "Micro/WIN leaves the network out without an error"


def found(text: str, others: str = "", newline: str = "\r\n", encoding: str = "ascii") -> list[str]:
    """Findings as `line:column: severity: message [rule]`."""
    source = decode_source("f.awl", text.replace("\n", newline).encode(encoding))
    blocks = parse(source)
    program = (*blocks, *parse(decode_source("g.awl", others.encode())))
    return [str(finding).removeprefix("f.awl:") for finding in findings(source, blocks, program)]


def main(*networks: str) -> str:
    body = "".join(f"Network {number}\n{text}\n" for number, text in enumerate(networks, 1))
    return f"ORGANIZATION_BLOCK MAIN:OB1\nBEGIN\n{body}END_ORGANIZATION_BLOCK\n"


def test_clean_files_pass() -> None:
    assert found(CLEAN, INTERRUPT) == []
    assert found(INTERRUPT) == []


BODIES = [
    (
        ["LD I0.0\n= Q0.0\nLD I0.1\n= Q0.1"],
        [f"6:1: error: second rung in one network: {LEFT_OUT}; begin a new network here [one-rung]"],
    ),
    (
        ["LD I0.0\nLPS\nA I0.1\n= Q0.0\nLPP\n= Q0.1\nLD I0.2\n= Q0.2\nLDW> VW0, +1\n= Q0.3"],
        [
            f"10:1: error: second rung in one network: {LEFT_OUT}; begin a new network here [one-rung]",
            f"12:1: error: second rung in one network: {LEFT_OUT}; begin a new network here [one-rung]",
        ],
    ),
    (
        ["LD I0.0\nFOR VW0, +1, +2", "LD I0.0\nNEXT"],
        [f"8:1: error: NEXT stands alone: {LEFT_OUT}; give it a network of its own [stand-alone]"],
    ),
    (
        ["LBL 1\nLD I0.0\n= Q0.0"],
        [f"4:1: error: LBL stands alone: {LEFT_OUT}; give it a network of its own [stand-alone]"],
    ),
    (
        ["LD I0.0\nINCB VB9\nFOR VW0, +1, +2", "NEXT"],
        [f"6:1: error: FOR needs a network of its own: {LEFT_OUT}; move the rest [stand-alone]"],
    ),
    (["JMP 1", "LBL 1"], [f"4:1: error: JMP without a condition before it: {LEFT_OUT}; begin with LD [logic-stack]"]),
    (
        ["MOVW +1, VW0\nMOVW +1, VW2"],
        [f"4:1: error: MOVW without a condition before it: {LEFT_OUT}; begin with LD [logic-stack]"],
    ),
    (
        ["LD I0.0\nOLD\n= Q0.0"],
        [f"5:1: error: OLD needs 2 levels of the logic stack, there is 1: {LEFT_OUT}; add an LD [logic-stack]"],
    ),
    (
        ["LD I0.0\n" * 32 + "LD I0.1"],
        ["36:1: error: the logic stack has 32 levels; split the network [logic-stack]"],
    ),
    (["MOVE VW0, VW2"], [f"4:1: error: unknown mnemonic MOVE: {LEFT_OUT}; did you mean MOVW? [mnemonic]"]),
    (
        ["LD SM0.0\nFROB"],
        [
            f"5:1: error: unknown mnemonic FROB: {LEFT_OUT}; write an instruction of the S7-200 SMART [mnemonic]",
        ],
    ),
    (
        ["LD Alwais_On\nMOVW Speed, VW0"],
        [
            f"4:4: error: unknown symbol Alwais_On: {LEFT_OUT}; did you mean Always_On? [symbol]",
            f"5:6: error: unknown symbol Speed: {LEFT_OUT}; write its address [symbol]",
        ],
    ),
    (
        ["TITLE = no\nLD I0.0\n= Q0.0"],
        ["4:1: error: TITLE inside a network breaks the import; write it as a // comment [title]"],
    ),
    (
        ["LD SM0.0\nMOVW 100, VW0\nMOVW 16#64, VW0\nMOVD 5, VD4\nMOVB +5, VB8\nFILL 0, VW0, 9\nTON T37, 20"],
        [
            "5:6: warning: 100 without a sign; Micro/WIN writes word constants as +100 [constant-sign]",
            "7:6: warning: 5 without a sign; Micro/WIN writes word constants as +5 [constant-sign]",
            "8:6: warning: +5 with a sign; Micro/WIN writes byte constants as 5 [constant-sign]",
            "9:6: warning: 0 without a sign; Micro/WIN writes word constants as +0 [constant-sign]",
            "10:10: warning: 20 without a sign; Micro/WIN writes word constants as +20 [constant-sign]",
        ],
    ),
    (["LD I0.0\nCRET"], ["5:1: error: CRET is not allowed in the main program; write END [place]"]),
    (["NEXT"], ["4:1: error: NEXT without FOR; write FOR above it [loop]"]),
    (
        ["LD I0.0\nFOR VW0, +1, +2"],
        ["5:1: error: FOR without NEXT; write NEXT in a network of its own [loop]"],
    ),
    (["LBL 1", "LBL 1"], ["6:1: error: LBL 1 stands twice in MAIN; give one another number [label]"]),
    (["LD I0.0\nJMP 2"], ["5:1: error: no LBL 2 in MAIN; a jump stays in its block [label]"]),
]


@pytest.mark.parametrize(("networks", "expected"), BODIES)
def test_networks(networks: list[str], expected: list[str]) -> None:
    assert found(main(*networks)) == expected


def routine(word: str) -> str:
    return f"INTERRUPT_BLOCK INT_0:INT0\nBEGIN\nNetwork 1\nLD     SM0.0\n{word}\nEND_INTERRUPT_BLOCK\n"


@pytest.mark.parametrize("word", ["ENI", "DISI", "HDEF"])
def test_forbidden_in_interrupts(word: str) -> None:
    assert found(routine(word)) == [
        f"5:1: error: {word} is not allowed in an interrupt routine; move it to the main program [place]"
    ]


def test_wrong_return() -> None:
    assert found(routine("END")) == ["5:1: error: END is not allowed in an interrupt routine; write CRETI [place]"]
    text = "SUBROUTINE_BLOCK a:SBR0\nBEGIN\nNetwork 1\nLD I0.0\nEND\nEND_SUBROUTINE_BLOCK\n"
    assert found(text) == ["5:1: error: END is not allowed in a subroutine; write CRET [place]"]


def subroutine(name: str, number: int, *callees: str) -> str:
    calls = "".join(f"CALL {callee}\n" for callee in callees)
    body = f"Network 1\nLD SM0.0\n{calls}" if calls else ""
    return f"SUBROUTINE_BLOCK {name}:SBR{number}\nBEGIN\n{body}END_SUBROUTINE_BLOCK\n"


def test_several_blocks_in_a_file() -> None:
    text = subroutine("a", 0, "b") + subroutine("b", 1) + main("LD SM0.0\nCALL a")
    assert found(text) == [
        "1:1: warning: a calls b, which stands below; put b first [block-order]",
        "7:1: warning: Micro/WIN may import the first block of a file alone; write a file for each block [one-block]",
        "10:1: warning: Micro/WIN may import the first block of a file alone; write a file for each block [one-block]",
        "10:1: warning: MAIN replaces the program when it is imported; put it first [block-order]",
    ]


def chain(length: int) -> str:
    return "".join(subroutine(f"s{n}", n, f"s{n + 1}") for n in range(length - 1)) + subroutine("last", length - 1)


def test_nesting_depth() -> None:
    text = main("LD SM0.0\nCALL s0")
    others = chain(9).replace("CALL s8", "CALL last")
    assert found(text, chain(8).replace("CALL s7", "CALL last")) == []
    assert found(text, others) == [
        "1:1: error: 9 subroutines inside one another (MAIN > s0 > s1 > s2 > s3 > s4 > s5 > s6 > s7 > last); 8 are the"
        " most [nesting-depth]"
    ]
    assert found(routine("CALL s4"), others) == [
        "1:1: error: 5 subroutines inside one another (INT_0 > s4 > s5 > s6 > s7 > last); 4 are the most"
        " [nesting-depth]"
    ]


def test_circle_of_calls() -> None:
    assert found(subroutine("a", 0, "b"), subroutine("b", 1, "a")) == [
        "1:1: error: a calls itself, if by way of others; break the circle [nesting-depth]"
    ]


def test_head() -> None:
    text = "PROGRAM_BLOCK MAIN:OB1\nBEGIN\nEND_PROGRAM_BLOCK\n"
    assert found(text) == [
        "1:1: error: Micro/WIN imports nothing from PROGRAM_BLOCK and says it went well; write ORGANIZATION_BLOCK"
        " [head]"
    ]


def test_names_and_local_variables() -> None:
    long = "AVeryLongNameOfTwentyFour"[:24]
    text = f"SUBROUTINE_BLOCK {long}:SBR0\nVAR_INPUT\nspeed : REAL;\nEND_VAR\nBEGIN\nEND_SUBROUTINE_BLOCK\n"
    assert found(text) == [
        f"1:1: error: {long} has 24 characters; 23 are the most, shorten it [identifier-length]",
        "3:1: warning: no export with local variables was seen, an import may drop them; use V memory [local-variable]",
    ]
    assert found(text.replace(long, long[:23])) == [found(text)[1]]


def test_bytes() -> None:
    assert found(INTERRUPT, newline="\n") == [
        "1:27: warning: 6 lines end with LF alone, this is the first; save with CRLF [line-end]"
    ]
    assert found(INTERRUPT, encoding="utf-8-sig") == [
        "1:1: error: Micro/WIN reads the byte order mark as text; save as ANSI or ASCII [byte-order-mark]"
    ]
    commented = INTERRUPT.replace("Network 1", "Network 1 // größe")
    assert found(commented, encoding="utf-8") == [
        "3:16: warning: UTF-8 character; Micro/WIN reads the code page of the PC, write ASCII [encoding]"
    ]
    assert found(commented, encoding="cp1252") == [
        "3:16: warning: this character depends on the code page of the PC; ASCII is safe everywhere [encoding]"
    ]


def test_each_rule_has_a_test() -> None:
    from pathlib import Path

    text = Path(__file__).read_text("utf-8")
    assert [rule.name for rule in RULES if f"[{rule.name}]" not in text] == []
