"""The instructions of the S7-200 SMART, as its manual lists them."""

from __future__ import annotations

from collections.abc import Mapping

from plcgen.plc.stl import smart_flow as flow
from plcgen.plc.stl import smart_logic as bits
from plcgen.plc.stl import smart_timing as timing
from plcgen.plc.stl.smart_boxes import (
    DECODE,
    ENCODE,
    SEVEN_SEGMENTS,
    binary_coded,
    bitwise,
    coded,
    converted,
    divide_wide,
    extended,
    function,
    inverted,
    milliseconds,
    milliseconds_since,
    moved,
    multiply_wide,
    rounded,
    shifted,
    stepped,
    swap,
    two_operands,
)
from plcgen.plc.stl.smart_loops import block_move, fill, put
from plcgen.plc.stl.smart_operators import CEVNT, DISI, DTCH, ENI, PLS, ROUND, STOP, TRUNC, WDR
from plcgen.plc.stl.smart_rung import FALSE, TRUE
from plcgen.plc.stl.smart_slots import (
    COUNTER,
    IN_BIT,
    OUT_BIT,
    TIMER,
    Row,
    block,
    box,
    logic,
    number,
    reads,
    writes,
    written,
)
from plcgen.plc.stl.syntax import BlockKind
from plcgen.plc.types import BOOL, BYTE, DINT, DWORD, INT, REAL, WORD

BITS_AND_COUNT = (written(BOOL), written(BYTE))
LEVEL = number(0, 31, "level of the logic stack")
LABEL = number(0, 255, "label")
EVENT = number(0, 44, "interrupt event")
CHANNEL = number(0, 2, "pulse output")
REGISTER = number(-64, 64, "number of bits")
ROUTINE = block(BlockKind.INTERRUPT)

CONTACTS: Mapping[str, Row] = {
    "LD": logic(bits.load, IN_BIT),
    "LDN": logic(bits.negated(bits.load), IN_BIT),
    "A": logic(bits.conjoin, IN_BIT),
    "AN": logic(bits.negated(bits.conjoin), IN_BIT),
    "O": logic(bits.disjoin, IN_BIT),
    "ON": logic(bits.negated(bits.disjoin), IN_BIT),
}
IMMEDIATE_CONTACTS = {f"{word}I": row for word, row in CONTACTS.items()}
"""LDI, LDNI ... read the input itself; here it is the same as its image."""

STACK: Mapping[str, Row] = {
    "EU": logic(bits.rising),
    "ED": logic(bits.falling),
    "NOT": logic(bits.invert),
    "ALD": logic(bits.and_load),
    "OLD": logic(bits.or_load),
    "LPS": logic(bits.logic_push),
    "LRD": logic(bits.logic_read),
    "LPP": logic(bits.logic_pop),
    "LDS": logic(bits.load_stack, LEVEL),
    "AENO": logic(bits.and_eno),
}

COILS: Mapping[str, Row] = {
    "=": logic(bits.coil, OUT_BIT),
    "=I": logic(bits.coil_now, OUT_BIT),
    "S": box(put(TRUE, bits.alone), *BITS_AND_COUNT),
    "R": box(put(FALSE, bits.current), *BITS_AND_COUNT),
    "SI": box(put(TRUE, bits.at_once), *BITS_AND_COUNT),
    "RI": box(put(FALSE, bits.at_once), *BITS_AND_COUNT),
}

COMPARES: Mapping[str, Row] = {
    f"{meet}{letter}{symbol}": logic(bits.compare(meeting, symbol), reads(kind), reads(kind))
    for meet, meeting in (("LD", bits.load), ("A", bits.conjoin), ("O", bits.disjoin))
    for letter, kind in (("B", BYTE), ("W", INT), ("D", DINT), ("R", REAL))
    for symbol in ("=", "<>", "<", "<=", ">", ">=")
}

MOVES: Mapping[str, Row] = {
    "MOVB": moved(BYTE),
    "MOVW": moved(INT),
    "MOVD": moved(DINT),
    "MOVR": moved(REAL),
    "BMB": box(block_move(BYTE), written(BYTE), written(BYTE), written(BYTE)),
    "BMW": box(block_move(INT), written(INT), written(INT), written(BYTE)),
    "BMD": box(block_move(DINT), written(DINT), written(DINT), written(BYTE)),
    "FILL": box(fill(INT), written(INT), written(INT), written(BYTE)),
    "SWAP": swap(),
    "BIR": moved(BYTE),
    "BIW": box(bits.write_now, reads(BYTE), writes(BYTE)),
}

ARITHMETIC: Mapping[str, Row] = {
    **{f"{symbol}I": two_operands(symbol, INT) for symbol in "+-*/"},
    **{f"{symbol}D": two_operands(symbol, DINT) for symbol in "+-*/"},
    **{f"{symbol}R": two_operands(symbol, REAL) for symbol in "+-*/"},
    "MUL": box(multiply_wide, reads(INT), writes(DINT)),
    "DIV": box(divide_wide, reads(INT), writes(DINT)),
    **{name: function(name) for name in ("SQRT", "SIN", "COS", "TAN", "LN", "EXP")},
    "INCB": stepped("+", BYTE),
    "INCW": stepped("+", INT),
    "INCD": stepped("+", DINT),
    "DECB": stepped("-", BYTE),
    "DECW": stepped("-", INT),
    "DECD": stepped("-", DINT),
}

CONVERSIONS: Mapping[str, Row] = {
    "BTI": extended(BYTE, INT),
    "ITB": converted(INT, BYTE),
    "ITD": extended(INT, DINT),
    "DTI": converted(DINT, INT),
    "DTR": extended(DINT, REAL),
    "ROUND": rounded(ROUND),
    "TRUNC": rounded(TRUNC),
    "DECO": coded("DECO", BYTE, WORD, DECODE),
    "ENCO": coded("ENCO", WORD, BYTE, ENCODE),
    "SEG": coded("SEG", BYTE, BYTE, SEVEN_SEGMENTS),
    "IBCD": binary_coded(to_bcd=True),
    "BCDI": binary_coded(to_bcd=False),
}

BITS_AND_SHIFTS: Mapping[str, Row] = {
    **{
        f"{word}{letter}": bitwise(symbol, kind)
        for word, symbol in (("AND", "AND"), ("OR", "OR"), ("XOR", "XOR"))
        for letter, kind in (("B", BYTE), ("W", WORD), ("D", DWORD))
    },
    **{f"INV{letter}": inverted(kind) for letter, kind in (("B", BYTE), ("W", WORD), ("D", DWORD))},
    **{
        f"{word}{letter}": shifted(symbol, kind)
        for word, symbol in (("SR", "SHR"), ("SL", "SHL"), ("RR", "ROR"), ("RL", "ROL"))
        for letter, kind in (("B", BYTE), ("W", WORD), ("D", DWORD))
    },
    "SHRB": box(bits.shift_register, IN_BIT, OUT_BIT, REGISTER),
}

COUNTING: Mapping[str, Row] = {
    "TON": logic(timing.on_delay(retentive=False), TIMER, reads(INT)),
    "TONR": logic(timing.on_delay(retentive=True), TIMER, reads(INT)),
    "TOF": logic(timing.off_delay, TIMER, reads(INT)),
    "CTU": logic(timing.count_up, COUNTER, reads(INT)),
    "CTD": logic(timing.count_down, COUNTER, reads(INT)),
    "CTUD": logic(timing.count_both, COUNTER, reads(INT)),
    "BITIM": box(milliseconds, writes(DINT)),
    "CITIM": box(milliseconds_since, reads(DINT), writes(DINT)),
}

CONTROL: Mapping[str, Row] = {
    "JMP": logic(flow.jump, LABEL),
    "LBL": logic(flow.label, LABEL),
    "FOR": logic(flow.begin_loop, writes(INT), reads(INT), reads(INT)),
    "NEXT": logic(flow.end_loop),
    "LSCR": logic(flow.begin_step, OUT_BIT),
    "SCRT": box(flow.next_step, OUT_BIT),
    "CSCRE": logic(flow.leave_step),
    "SCRE": logic(flow.end_step),
    "CALL": Row(flow.call, None, is_box=True),
    "CRET": logic(flow.leave),
    "CRETI": logic(flow.leave),
    "END": logic(flow.leave),
    "STOP": box(flow.served(STOP)),
    "WDR": box(flow.served(WDR)),
    "NOP": logic(flow.nothing, LABEL),
}

INTERRUPTS_AND_PULSES: Mapping[str, Row] = {
    "ATCH": box(flow.attach, ROUTINE, EVENT),
    "DTCH": box(flow.served(DTCH), EVENT),
    "CEVNT": box(flow.served(CEVNT), EVENT),
    "ENI": box(flow.served(ENI)),
    "DISI": box(flow.served(DISI)),
    "PLS": box(flow.served(PLS), CHANNEL),
}

MNEMONICS: Mapping[str, Row] = {
    **CONTACTS,
    **IMMEDIATE_CONTACTS,
    **STACK,
    **COILS,
    **COMPARES,
    **MOVES,
    **ARITHMETIC,
    **CONVERSIONS,
    **BITS_AND_SHIFTS,
    **COUNTING,
    **CONTROL,
    **INTERRUPTS_AND_PULSES,
}

# fmt: off
UNSUPPORTED = frozenset([
    "AD_T", "ATH", "ATT", "CFND", "DLED", "DTA", "DTS",
    "FIFO", "FND<", "FND<>", "FND=", "FND>", "GET", "GPA", "HDEF", "HSC", "HTA", "ITA", "ITS",
    "LIFO", "NETR", "NETW", "PID", "PUT", "RCV", "RSET", "RTA", "RTS", "SCAT", "SCPY",
    "SFND", "SLEN", "SPA", "SSCPY", "STD", "STI", "STR", "TODR", "TODRX", "TODW", "TODWX", "XMT",
    "AS<>", "AS=", "LDS<>", "LDS=", "OS<>", "OS=",
])
# fmt: on
"""Instructions that exist and are not executed here."""
