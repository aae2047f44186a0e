"""What STL of STEP 7 V5 writes differently from SCL, and its two sets of mnemonics."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import replace
from enum import Enum

from plcgen.plc.lexer import (
    ASCII_NAME,
    BASED,
    BLANKS,
    DIGITS,
    NUMBER,
    OPERATORS,
    QUOTED_NAME,
    STRING,
    TYPED_PATTERNS,
    UNCLOSED,
    Lexicon,
    TokenKind,
)
from plcgen.plc.scl.dialects import CLASSIC
from plcgen.plc.source import SourceText

COMMENT = r"//[^\n]*"

_CLOSED = f"(?!{STRING}|#?{QUOTED_NAME})"

DECLARATIONS = Lexicon(
    (BLANKS, COMMENT),
    (
        *((TokenKind.TYPED, pattern) for pattern in TYPED_PATTERNS),
        (TokenKind.NUMBER, f"{BASED}|{NUMBER}"),
        (TokenKind.NAME, ASCII_NAME),
        (TokenKind.LOCAL, f"#(?:{ASCII_NAME}|{QUOTED_NAME})"),
        (TokenKind.GLOBAL, QUOTED_NAME),
        (TokenKind.STRING, STRING),
        (TokenKind.OPERATOR, OPERATORS),
    ),
    (
        (r"\(\*", "(* *) is no comment in STL; write //"),
        (rf"{DIGITS}\.(?![0-9.])", "{text} needs a digit after the point; write {text}0"),
        *((_CLOSED + pattern, message) for pattern, message in UNCLOSED),
    ),
)

STL = replace(CLASSIC, name="stl", title="STL of STEP 7 V5", lexicon=DECLARATIONS, header_quotes=False)
"""The dialect of declarations, initial values and constants."""


class Language(Enum):
    """The set of mnemonics that a source is written in, a setting of the SIMATIC Manager."""

    ENGLISH = "English"
    GERMAN = "German"


# What a German mnemonic is called in English, where the two differ.
GERMAN: Mapping[str, str] = {
    "U": "A",
    "UN": "AN",
    "U(": "A(",
    "UN(": "AN(",
    "UW": "AW",
    "UD": "AD",
    "AUF": "OPN",
    "TDB": "CDB",
    "TAR": "CAR",
    "TAW": "CAW",
    "TAD": "CAD",
    "SPA": "JU",
    "SPB": "JC",
    "SPBN": "JCN",
    "SPBB": "JCB",
    "SPBNB": "JNB",
    "SPBI": "JBI",
    "SPBIN": "JNBI",
    "SPO": "JO",
    "SPS": "JOS",
    "SPZ": "JZ",
    "SPN": "JN",
    "SPP": "JP",
    "SPM": "JM",
    "SPPZ": "JPZ",
    "SPMZ": "JMZ",
    "SPU": "JUO",
    "SPL": "JL",
    "BEA": "BEU",
    "BEB": "BEC",
    "ZV": "CU",
    "ZR": "CD",
    "SI": "SP",
    "SV": "SE",
    "SE": "SD",
    "SA": "SF",
}
# What is spelt the same in both stands in neither set; SE is another timer in each.
_OWN = {
    Language.GERMAN: frozenset(GERMAN) - {"SE"},
    Language.ENGLISH: frozenset(GERMAN.values()) - {"SE"},
}
AREAS: Mapping[Language, Mapping[str, str]] = {
    Language.ENGLISH: {area: area for area in ("I", "Q", "M", "L", "PI", "PQ", "DB", "DI")},
    Language.GERMAN: {"E": "I", "A": "Q", "M": "M", "L": "L", "PE": "PI", "PA": "PQ", "DB": "DB", "DI": "DI"},
}
"""Letters of an operand, and the area they mean."""

_WORD = re.compile(rf"(?m){COMMENT}|'[^'\r\n]*'|(?:^|[:;])[ \t]*([A-Za-z]+\(?)(?=[^0-9A-Za-z_:]|$)")
# An input or a peripheral address: E 0.0, EW 2, PAW 256.
_GERMAN_ADDRESS = re.compile(r"(?im)^[^/'\"\n]*(?<![#\".\w])(?:P?E[BWD]?|PA[BWD])[ \t]*[0-9]+(?:\.[0-7])?[ \t]*;")


def english(word: str, language: Language) -> str:
    """The English mnemonic for a word in upper case; a word of the other set stays as it is."""
    return GERMAN.get(word, word) if language is Language.GERMAN else word


def detect_language(source: SourceText) -> Language:
    """Whichever set has more words of its own in the text; where neither has, addresses tell."""
    words = [match[1].upper() for match in _WORD.finditer(source.text) if match[1]]
    german, own = (sum(word in _OWN[language] for word in words) for language in (Language.GERMAN, Language.ENGLISH))
    if german == own:
        return Language.GERMAN if _GERMAN_ADDRESS.search(source.text) else Language.ENGLISH
    return Language.GERMAN if german > own else Language.ENGLISH
