"""German mnemonics of S7-300 STL: a rendered text is translated word by word, by two tables."""

from __future__ import annotations

import re

# What is not listed is spelt alike in both: L, T, S, R, =, O, X, SET, TAK, CALL, LOOP, +R, SQRT ...
INSTRUCTIONS = {
    # Bit logic
    "A": "U",
    "AN": "UN",
    "A(": "U(",
    "AN(": "UN(",
    # Words
    "AW": "UW",
    "AD": "UD",
    # Jumps
    "JU": "SPA",
    "JC": "SPB",
    "JCN": "SPBN",
    "JCB": "SPBB",
    "JNB": "SPBNB",
    "JBI": "SPBI",
    "JNBI": "SPBIN",
    "JO": "SPO",
    "JOS": "SPS",
    "JZ": "SPZ",
    "JN": "SPN",
    "JP": "SPP",
    "JM": "SPM",
    "JPZ": "SPPZ",
    "JMZ": "SPMZ",
    "JUO": "SPU",
    "JL": "SPL",
    # Ends of blocks, data blocks, accumulators
    "BEC": "BEB",
    "BEU": "BEA",
    "OPN": "AUF",
    "CDB": "TDB",
    "CAW": "TAW",
    "CAD": "TAD",
    "CAR": "TAR",
    # Timers and counters
    "SP": "SI",
    "SE": "SV",
    "SD": "SE",
    "SF": "SA",
    "CU": "ZV",
    "CD": "ZR",
}
# Letters of an address before its number, and the bit of the status word.
ADDRESSES = {
    "I": "E",
    "IB": "EB",
    "IW": "EW",
    "ID": "ED",
    "Q": "A",
    "QB": "AB",
    "QW": "AW",
    "QD": "AD",
    "PIB": "PEB",
    "PIW": "PEW",
    "PID": "PED",
    "PQB": "PAB",
    "PQW": "PAW",
    "PQD": "PAD",
    "C": "Z",
    "BR": "BIE",
}
_END = re.compile(r"END_")
_NO_INSTRUCTION = re.compile(r"\s*(?://|TITLE *=|$)")
_INSTRUCTION = re.compile(
    r"""(?P<label>\s*(?:[A-Za-z_]\w{0,3}\s*:(?!=)\s*)?)
        (?P<word>[^\s;]+)
        (?P<rest>.*)""",
    re.VERBOSE,
)
# Comments, symbols, local names and what belongs to a longer word (DB1.DBX0.0, W#16#C000) are passed over.
_ADDRESS = re.compile(r"""(?P<kept>//.*|"[^"]*"|\#\w+|[\w.]+[.\#]\w+)|\b(?P<area>[A-Z]{1,3})(?=\s*(?:[\d\[]|;))""")


def to_german(text: str) -> str:
    """An AWL text, one instruction a line, with instructions and addresses in German.

    Instructions stand between BEGIN and the end of a block. Comments, names and declarations stay as they are, and so
    do the values of a data block.
    """
    lines = []
    inside = False
    for line in text.split("\n"):
        if line.strip() == "BEGIN":
            inside = True
        elif _END.match(line):
            inside = False
        elif inside and not _NO_INSTRUCTION.match(line):
            line = _statement(line)
        lines.append(line)
    return "\n".join(lines)


def _statement(line: str) -> str:
    """An instruction, or a value or parameter that is assigned."""
    found = _INSTRUCTION.fullmatch(line)
    if not found or found["rest"].lstrip().startswith(":"):
        return _ADDRESS.sub(_address, line)
    word = INSTRUCTIONS.get(found["word"], found["word"])
    rest = _ADDRESS.sub(_address, found["rest"])
    return found["label"] + word + _aligned(rest, len(word) - len(found["word"]))


def _address(found: re.Match[str]) -> str:
    return found["kept"] or ADDRESSES.get(found["area"], found["area"])


def _aligned(rest: str, longer: int) -> str:
    """What follows a word stays in its column where blanks are left for it."""
    blanks = len(rest) - len(rest.lstrip(" "))
    return " " * max(blanks - longer, min(blanks, 1)) + rest[blanks:]
