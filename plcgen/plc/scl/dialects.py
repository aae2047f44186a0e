"""SCL as STEP 7 V5 spells it and as a TIA external source spells it: two tables of differences."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass, field
from types import MappingProxyType

from plcgen.plc.lexer import SCL_CLASSIC, SCL_TIA, Lexicon
from plcgen.plc.source import BYTE_ORDER_MARK, SourceText


def words(text: str) -> frozenset[str]:
    """The words of a list."""
    return frozenset(text.split())


STRUCTURE_WORDS = words("""
    AND ARRAY AT BEGIN BY CASE CONST CONTINUE DATA_BLOCK DIV DO ELSE ELSIF END_CASE END_CONST END_DATA_BLOCK END_FOR
    END_FUNCTION END_FUNCTION_BLOCK END_IF END_LABEL END_ORGANIZATION_BLOCK END_REPEAT END_STRUCT END_TYPE END_VAR
    END_WHILE EXIT FALSE FOR FUNCTION FUNCTION_BLOCK GOTO IF LABEL MOD NOT OF OR ORGANIZATION_BLOCK REPEAT RETURN
    STRUCT THEN TO TRUE TYPE UNTIL VAR VAR_INPUT VAR_IN_OUT VAR_OUTPUT VAR_TEMP VOID WHILE XOR
""")
HEADER_WORDS = words("AUTHOR FAMILY KNOW_HOW_PROTECT NAME NON_RETAIN READ_ONLY RETAIN TITLE UNLINKED VERSION")
FLAG_WORDS = words("EN ENO NIL OK PROGRAM END_PROGRAM")

S7300_TYPES = words("""
    BOOL BYTE WORD DWORD CHAR INT DINT REAL TIME DATE TIME_OF_DAY TOD S5TIME DATE_AND_TIME DT STRING
""")
PARAMETER_TYPES = words("ANY BLOCK_DB BLOCK_FB BLOCK_FC BLOCK_SDB BLOCK_SFB BLOCK_SFC COUNTER POINTER TIMER")
S71500_TYPES = words("LREAL SINT LINT USINT UINT UDINT ULINT LWORD")
# Types of TIA that no machine here can hold.
UNSUPPORTED_TYPES = words("LTIME LTOD LTIME_OF_DAY LDT DTL WCHAR WSTRING VARIANT REF_TO DB_ANY")
TYPE_ALIASES: Mapping[str, str] = MappingProxyType({"TOD": "TIME_OF_DAY", "DT": "DATE_AND_TIME"})

STANDARD_FUNCTIONS = words("""
    ABS SQR SQRT EXP EXPD LN LOG SIN COS TAN ASIN ACOS ATAN ROUND TRUNC ROL ROR SHL SHR MIN MAX LIMIT SEL MUX
    LEN CONCAT LEFT RIGHT MID INSERT DELETE REPLACE FIND CEIL FLOOR FRAC NORM_X SCALE_X MOVE
    TON TOF TP CTU CTD CTUD R_TRIG F_TRIG
""")

RESERVED_WORDS: frozenset[str] = (
    STRUCTURE_WORDS
    | HEADER_WORDS
    | FLAG_WORDS
    | S7300_TYPES
    | PARAMETER_TYPES
    | S71500_TYPES
    | UNSUPPORTED_TYPES
    | STANDARD_FUNCTIONS
    | {"REGION", "END_REGION", "CONSTANT"}
)
"""Words, in upper case, that a name of ours avoids in every dialect, whether its compiler insists or not."""


@dataclass(frozen=True)
class Dialect:
    """What one compiler writes differently.

    `reserved` cannot be declared; `absent` maps a function or operator the compiler lacks to what is written instead;
    `header_quotes`: VERSION and TITLE stand in quotes; `integers`: range of a decimal literal; `bits`: width of a
    based one.
    """

    name: str
    title: str
    lexicon: Lexicon = field(repr=False)
    reserved: frozenset[str] = field(repr=False)
    types: frozenset[str] = field(repr=False)
    identifier_length: int
    header_quotes: bool
    typed_constants: bool
    real_needs_point: bool
    regions: bool
    compound_assignment: bool
    begin_required: bool
    output_arrow: bool
    integers: tuple[int, int]
    bits: int
    absent: Mapping[str, str] = field(default_factory=dict, repr=False, compare=False)


CLASSIC = Dialect(
    name="classic",
    title="STEP 7 V5",
    lexicon=SCL_CLASSIC,
    reserved=STRUCTURE_WORDS | FLAG_WORDS | S7300_TYPES | PARAMETER_TYPES,
    types=S7300_TYPES,
    identifier_length=24,
    header_quotes=True,
    typed_constants=False,
    real_needs_point=False,
    regions=False,
    compound_assignment=False,
    begin_required=False,
    output_arrow=False,
    integers=(-(2**31), 2**31 - 1),
    bits=32,
)

TIA = Dialect(
    name="tia",
    title="TIA",
    lexicon=SCL_TIA,
    reserved=STRUCTURE_WORDS | {"REGION", "END_REGION"},
    types=S7300_TYPES | S71500_TYPES,
    identifier_length=128,
    header_quotes=False,
    typed_constants=True,
    real_needs_point=True,
    regions=True,
    compound_assignment=True,
    begin_required=True,
    output_arrow=True,
    integers=(-(2**63), 2**64 - 1),
    bits=64,
    absent=MappingProxyType({"EXPD": "EXP(x * 2.302585)", "LOG": "LN(x) * 0.4342945", "DIV": "/"}),
)

# ------------------------------------------------------------------------------------------------------ detection

_NOISE = re.compile(r"//[^\n]*|\(\*.*?(?:\*\)|\Z)|'[^'\r\n]*'", re.DOTALL)

# Each mark speaks for one dialect; the numbers say how rarely the other one shows it.
_MARKS: tuple[tuple[str, Dialect, int], ...] = (
    (r"(?im)^\s*VERSION\s*:\s*''", CLASSIC, 4),
    (r"(?im)^\s*TITLE\s*=\s*''", CLASSIC, 2),
    (r"(?i)\bEND_CONST\b", CLASSIC, 8),
    (r"(?i)\b(?:FUNCTION|FUNCTION_BLOCK|DATA_BLOCK|ORGANIZATION_BLOCK)\s+(?:FB|FC|DB|OB)[0-9]", CLASSIC, 4),
    (r"(?i)\bF[BC][0-9]+\s*\.\s*DB[0-9]+\s*\(", CLASSIC, 8),
    (r"(?im)^\s*VERSION\s*:\s*[0-9]", TIA, 4),
    (r"(?i)\bVAR\s+CONSTANT\b", TIA, 8),
    (r"(?i)\bS7_Optimized_Access\b", TIA, 8),
    (r'(?<![0-9A-Za-z_])#["A-Za-z_]', TIA, 4),
    (r"(?im)^\s*(?:END_)?REGION\b", TIA, 8),
    (r"[-+*/]=", TIA, 8),
    (r"%(?:[IQM]|DB)[0-9BWDX]", TIA, 2),
)


def detect_dialect(source: SourceText) -> Dialect:
    """The dialect that most marks of the text speak for; STEP 7 V5 when none does."""
    text = _NOISE.sub(lambda match: "''" if match.group().startswith("'") else " ", source.text)
    votes = {CLASSIC.name: 0, TIA.name: 4 if source.raw.startswith(BYTE_ORDER_MARK) else 0}
    for pattern, dialect, weight in _MARKS:
        votes[dialect.name] += weight if re.search(pattern, text) else 0
    return TIA if votes[TIA.name] > votes[CLASSIC.name] else CLASSIC
