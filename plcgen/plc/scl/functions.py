"""Standard functions of SCL: their formal parameters and the operator row behind each; and those not built yet."""

from __future__ import annotations

import re
from dataclasses import dataclass

from plcgen.plc.scl.dialects import words


@dataclass(frozen=True)
class StandardFunction:
    """`repeated` parameters are numbered (IN1, IN2 ...) from `first`; the operator is applied from left to right."""

    operator: str
    parameters: tuple[str, ...] = ("IN",)
    repeated: str | None = None
    first: int = 1

    def names(self, count: int) -> tuple[str, ...]:
        """The formal names of a call with this many arguments."""
        if self.repeated is None:
            return self.parameters
        extra = max(2, count - len(self.parameters))
        return (*self.parameters, *(f"{self.repeated}{self.first + number}" for number in range(extra)))


_ONE_OPERAND = [
    "ABS",
    "SQR",
    "SQRT",
    "EXP",
    "EXPD",
    "LN",
    "LOG",
    "SIN",
    "COS",
    "TAN",
    "ASIN",
    "ACOS",
    "ATAN",
    "ROUND",
    "TRUNC",
    "CEIL",
    "FLOOR",
]

FUNCTIONS = {
    **{name: StandardFunction(name) for name in _ONE_OPERAND},
    **{name: StandardFunction(name, ("IN", "N")) for name in ("SHL", "SHR", "ROL", "ROR")},
    "MIN": StandardFunction("MIN", (), "IN"),
    "MAX": StandardFunction("MAX", (), "IN"),
    "LIMIT": StandardFunction("LIMIT", ("MN", "IN", "MX")),
    "SEL": StandardFunction("SEL", ("G", "IN0", "IN1")),
    "MUX": StandardFunction("SEL", ("K",), "IN", 0),
}

_ABSENT = words("""
    LEN CONCAT LEFT RIGHT MID INSERT DELETE REPLACE FIND FRAC NORM_X SCALE_X MOVE MOVE_BLK UMOVE_BLK FILL_BLK
    UFILL_BLK MOVE_BLK_VARIANT SWAP PEEK POKE SERIALIZE DESERIALIZE STRG_VAL VAL_STRG VARIANTGET VARIANTPUT
    RD_SYS_T WR_SYS_T RD_LOC_T RUNTIME BCD_TO_INT INT_TO_BCD BCD_TO_DINT DINT_TO_BCD T_ADD T_SUB T_DIFF T_COMBINE
    S_CU S_CD S_CUD S_PULSE S_PEXT S_ODT S_ODTS S_OFFDT
    TON TOF TP TONR TON_TIME TOF_TIME TP_TIME TONR_TIME TON_LTIME TOF_LTIME TP_LTIME IEC_TIMER
    CTU CTD CTUD CTU_INT CTD_INT CTUD_INT CTU_DINT CTD_DINT CTUD_DINT IEC_COUNTER R_TRIG F_TRIG
""")
_SYSTEM_BLOCK = re.compile(r"SF[BC][0-9]+")
_CONVERSION = re.compile(r"\w+_TO_W?(?:STRING|CHAR)|W?STRING_TO_\w+")


def is_absent(name: str) -> bool:
    """Whether a function, function block or type of the engineering tools is one that is not built here."""
    word = name.upper()
    return word in _ABSENT or any(pattern.fullmatch(word) for pattern in (_SYSTEM_BLOCK, _CONVERSION))
