"""Names that may stand in generated PLC source, and how a mistyped word finds its neighbour."""

from __future__ import annotations

import re
from collections.abc import Iterable
from difflib import get_close_matches

# Words of both SCL dialects: a name must survive a change of target. The SCL packages keep their own tables for
# reading source; a test holds that whatever they reserve is refused here too.
TYPES = frozenset(
    """
    BOOL BYTE CHAR DATE DATE_AND_TIME DB_ANY DINT DT DTL DWORD INT LDT LINT LREAL LTIME LTIME_OF_DAY LTOD LWORD REAL
    S5TIME SINT STRING TIME TIME_OF_DAY TOD UDINT UINT ULINT USINT WCHAR WORD WSTRING
    """.split()  # noqa: SIM905 - a table of words reads best as words
)
RESERVED_WORDS = TYPES | frozenset(
    """
    ALTERNATIVE ALTERNATIVE_BRANCH AND ANY ARRAY AT AUTHOR BEGIN BLOCK_DB BLOCK_FB BLOCK_FC BLOCK_SDB BLOCK_SFB
    BLOCK_SFC BY CASE CODE_VERSION1 CONST CONSTANT CONTINUE COUNTER DATA_BLOCK DIV DO ELSE ELSIF EN ENO END END_CASE
    END_CONST END_DATA_BLOCK END_FOR END_FUNCTION END_FUNCTION_BLOCK END_IF END_LABEL END_NETWORK
    END_ORGANIZATION_BLOCK END_PROGRAM END_REGION END_REPEAT END_STRUCT END_TYPE END_VAR END_WHILE EXIT FALSE FAMILY
    FOR FUNCTION FUNCTION_BLOCK GOTO IF KNOW_HOW_PROTECT LABEL MOD NAME NETWORK NIL NON_RETAIN NOT NULL OF OK OR
    ORGANIZATION_BLOCK POINTER PROGRAM READ_ONLY REF_TO REGION REPEAT RET_VAL RETAIN RETURN STANDARD STRUCT THEN
    THIS TIMER TITLE TO TRUE TYPE UNLINKED UNTIL VAR VAR_GLOBAL VAR_IN_OUT VAR_INPUT VAR_OUTPUT VAR_TEMP VARIANT
    VERSION VOID WHILE XOR

    ABS ACOS ASIN ATAN CEIL CONCAT COS CTD CTU CTUD DELETE EXP EXPD EXPT F_TRIG FILL_BLK FIND FLOOR FRAC INSERT LEFT
    LEN LIMIT LN LOG MAX MID MIN MOVE MOVE_BLK MUX NORM_X PEEK POKE R_TRIG REPLACE RIGHT ROL ROR ROUND S_AVERZ S_CD
    S_CU S_CUD S_EVERZ S_IMPULS S_ODT S_ODTS S_OFFDT S_PEXT S_PULSE S_SEVERZ S_VIMP SCALE_X SEL SHL SHR SIN SQR SQRT
    SWAP TAN TOF TON TONR TP TRUNC

    OB FB FC DB DI DIX UDT SFB SFC SDB VAT

    CALL NOP SAVE SET CLR TAK
    """.split()  # noqa: SIM905
)
# Files of Windows that no other file can be named after.
DEVICES = frozenset(
    {"CON", "PRN", "AUX", "NUL", *(f"{port}{number}" for port in ("COM", "LPT") for number in range(10))}
)
# Blocks that most projects hold already: an import would overwrite or clash with them.
STANDARD_BLOCKS = frozenset({"MAIN", "STARTUP", "CYCL_EXC", "CYC_INT5", "COMPLETE_RESTART"})
# Block numbers, timers and counters, and the operand areas with their widths, in English and German letters.
_ADDRESS = re.compile(r"(OB|FB|FC|DB|DI|UDT|SFB|SFC|SDB|VAT|[TCZ]|(?:PI|PQ|PE|PA|DB|DI|[IQMEALD])[BWDX]?)\d+")
_CONVERTIBLE = TYPES | {"BCD", "WORD_BCD", "DWORD_BCD", "BCD_WORD", "BCD_DWORD", "BLOCK_DB"}
_IDENTIFIER = re.compile(r"[A-Za-z](?:_?[A-Za-z0-9])*")
_WRONG_CHARACTER = re.compile(r"[^A-Za-z0-9_]")


def name_fault(name: str) -> str | None:
    """What is wrong with a name of a block, whatever the target, as the end of a sentence; None when it is right.

    Stricter than either compiler where their manuals leave room (underscores), so that no version objects.
    """
    wrong = _WRONG_CHARACTER.search(name)
    if wrong:
        return f"holds {spelled_character(wrong.group())}; write letters A-Z, digits and underscores"
    if not _IDENTIFIER.fullmatch(name):
        return "is no SCL name; begin with a letter, set single underscores and none at the end"
    upper = name.upper()
    if upper in RESERVED_WORDS or {*upper.split("_TO_")} < _CONVERTIBLE:
        return f"is a reserved word of SCL; write another name, such as {name}_1"
    if upper in STANDARD_BLOCKS:
        return "is the name of a block that most projects have already; write another name"
    if upper in DEVICES:
        return "is a device of Windows, which takes no file of that name; write another name"
    if _ADDRESS.fullmatch(upper):
        return "reads as an address; write a name that is not an area and a number"
    return None


def nearest(word: str, known: Iterable[str]) -> str | None:
    """The known word that a mistyped one most likely means, whatever its case; None when none is near."""
    by_lower = {candidate.lower(): candidate for candidate in known}
    lower = word.lower()
    parts = (other for other in by_lower if min(len(other), len(lower)) >= 3 and (other in lower or lower in other))
    close = get_close_matches(lower, by_lower, n=1, cutoff=0.65)
    return next((by_lower[other] for other in (*close, *parts)), None)


def one_of(words: Iterable[str]) -> str:
    """`"m", "cm" or "mm"`."""
    *others, last = (f'"{word}"' for word in words)
    return f"{', '.join(others)} or {last}" if others else last


def spelled_character(character: str) -> str:
    """A character in words where it would not show."""
    known = {" ": "a blank", "\n": "a line end", "\r": "a line end", "\t": "a tab", '"': "a quote", "'": "a quote"}
    plain = character if character.isprintable() else f"U+{ord(character):04X}"
    return known.get(character, f"the character {plain}")
