"""Colours for the sources of the report: SCL and STL for Pygments, which has neither."""

from __future__ import annotations

from typing import ClassVar

from pygments import highlight
from pygments.formatters import HtmlFormatter
from pygments.lexer import Lexer, RegexLexer, bygroups, words
from pygments.lexers.configs import TOMLLexer
from pygments.token import Comment, Keyword, Name, Number, Operator, String, Text

BLOCKS = (
    "FUNCTION",
    "FUNCTION_BLOCK",
    "ORGANIZATION_BLOCK",
    "DATA_BLOCK",
    "SUBROUTINE_BLOCK",
    "INTERRUPT_BLOCK",
    "TYPE",
)
SECTIONS = (
    "VAR",
    "VAR_INPUT",
    "VAR_IN_OUT",
    "VAR_OUTPUT",
    "VAR_TEMP",
    "CONST",
    "CONSTANT",
    "BEGIN",
    "STRUCT",
    "ARRAY",
    "OF",
)
BRANCHES = (
    "IF",
    "THEN",
    "ELSIF",
    "ELSE",
    "CASE",
    "FOR",
    "TO",
    "BY",
    "DO",
    "WHILE",
    "REPEAT",
    "UNTIL",
    "RETURN",
    "EXIT",
)
VALUES = ("ARRAY", "OF", "AND", "OR", "XOR", "NOT", "MOD", "DIV", "TRUE", "FALSE")
KEYWORDS = (*BLOCKS, *SECTIONS, *BRANCHES, *VALUES, *(f"END_{word}" for word in (*BLOCKS, *SECTIONS, *BRANCHES)))
TYPES = ("BOOL", "BYTE", "WORD", "DWORD", "CHAR", "INT", "DINT", "REAL", "LREAL", "TIME", "DATE", "STRING", "VOID")
NUMBER = r"\b(?:[A-Z]+#)?\d[\d_]*(?:\.\d+)?(?:[eE][+-]?\d+)?\b|\b(?:[A-Z]*#?)?(?:2|8|16)#[0-9A-Fa-f_]+"


class SclLexer(RegexLexer):
    """SCL of STEP 7 V5 and TIA Portal."""

    name = "SCL"
    tokens: ClassVar = {
        "root": [
            (r"//[^\n]*", Comment.Single),
            (r"\(\*[\s\S]*?\*\)", Comment.Multiline),
            (r"^(\s*)(TITLE|VERSION|AUTHOR|FAMILY|NAME)\b([^\n]*)", bygroups(Text, Keyword.Pseudo, String)),
            (r'"[^"\n]*"', Name.Other),
            (r"'[^'\n]*'", String),
            (words(KEYWORDS, prefix=r"\b", suffix=r"\b"), Keyword),
            (words(TYPES, prefix=r"\b", suffix=r"\b"), Keyword.Type),
            (NUMBER, Number),
            (r"#?[A-Za-z_]\w*", Name),
            (r":=|=>|<>|<=|>=|[-+*/=<>&]", Operator),
            (r"\s+|.", Text),
        ]
    }


class StlLexer(RegexLexer):
    """STL of STEP 7 V5 and Micro/WIN SMART: a mnemonic, then operands."""

    name = "STL"
    tokens: ClassVar = {
        "root": [
            (r"//[^\n]*", Comment.Single),
            (r"^(\s*)(TITLE|VERSION|NETWORK|Network)\b([^\n/]*)", bygroups(Text, Keyword.Pseudo, String)),
            (words(KEYWORDS, prefix=r"\b", suffix=r"\b"), Keyword),
            (words(TYPES, prefix=r"\b", suffix=r"\b"), Keyword.Type),
            (r"^(\w{1,4}:)?([ \t]*)([A-Z+*/<>=()-][A-Z0-9+*/<>=()-]*)(?=[ \t])", bygroups(Name.Label, Text, Keyword)),
            (NUMBER, Number),
            (r"#?[A-Za-z_]\w*", Name),
            (r"\s+|.", Text),
        ]
    }


LEXERS: dict[str, type[Lexer]] = {".scl": SclLexer, ".awl": StlLexer, ".toml": TOMLLexer}
_FORMATTER = HtmlFormatter(style="default", cssclass="source", nowrap=False)


def highlighted(text: str, suffix: str) -> str:
    """HTML of a source; `suffix` of its file says the language."""
    lexer = LEXERS[suffix](stripnl=False)
    return str(highlight(text, lexer, _FORMATTER))


def stylesheet() -> str:
    return str(_FORMATTER.get_style_defs(".source"))
