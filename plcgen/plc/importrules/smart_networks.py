"""Rules about networks for Micro/WIN SMART, which leaves an invalid one out of the program without a word."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass, field

from plcgen.plc.importrules.finding import Hit
from plcgen.plc.importrules.smart_subject import SmartSubject, word_span
from plcgen.plc.source import Span
from plcgen.plc.stl.smart_rung import STACK_LEVELS
from plcgen.plc.stl.smart_slots import Typed
from plcgen.plc.stl.smart_table import COILS, COMPARES, COUNTING, MNEMONICS, UNSUPPORTED
from plcgen.plc.stl.syntax import Block, BlockKind, Constant, Name, Network, Statement
from plcgen.plc.suggest import did_you_mean
from plcgen.plc.types import BYTE, DINT, DWORD, INT, WORD

LEFT_OUT = "Micro/WIN leaves the network out without an error"
LOADS = frozenset(word for word in (*COMPARES, "LD", "LDN", "LDI", "LDNI") if word.startswith("LD"))
ALONE = frozenset({"NEXT", "LBL", "LSCR", "SCRE"})
ENDINGS = frozenset({"JMP", "FOR", "CRET", "CRETI", "END", "CSCRE"})
FORBIDDEN = {
    BlockKind.INTERRUPT: frozenset({"DISI", "ENI", "HDEF", "END", "CRET"}),
    BlockKind.SUBROUTINE: frozenset({"END", "CRETI"}),
    BlockKind.ORGANIZATION: frozenset({"CRET", "CRETI"}),
}


OUTPUTS = frozenset(word for word, row in MNEMONICS.items() if row.is_box) | {*COILS, *COUNTING, *ENDINGS}
"""Coils and boxes: what a rung ends with."""


# ----------------------------------------------------------------------------------------------------------- words


def title_inside(subject: SmartSubject) -> Iterator[Hit]:
    for _, network in subject.networks():
        for span in network.titles:
            yield span, "TITLE inside a network breaks the import; write it as a // comment"


def known_mnemonic(subject: SmartSubject) -> Iterator[Hit]:
    for _, statement in subject.statements():
        word = statement.mnemonic
        if word not in MNEMONICS and word not in UNSUPPORTED:
            near = did_you_mean(word, MNEMONICS) or "; write an instruction of the S7-200 SMART"
            yield word_span(statement), f"unknown mnemonic {word}: {LEFT_OUT}{near}"


def known_symbol(subject: SmartSubject) -> Iterator[Hit]:
    for block, statement in subject.statements():
        own = [item.name for item in block.declarations]
        for operand in statement.operands:
            if not isinstance(operand, Name) or _means_something(subject, own, operand.text):
                continue
            if statement.mnemonic in ("CALL", "ATCH") and operand is statement.operands[0]:
                yield operand.span, f"no block {operand.text} in these files: {LEFT_OUT}; name its file too"
            else:
                near = subject.names.near(operand.text, own) or "; write its address"
                yield operand.span, f"unknown symbol {operand.text}: {LEFT_OUT}{near}"


def _means_something(subject: SmartSubject, own: list[str], name: str) -> bool:
    block = any(subject.names.block(name, kind) for kind in BlockKind)
    local = name.casefold() in (item.casefold() for item in own)
    return block or local or subject.names.address(name, Span(0, 0)) is not None


def constant_sign(subject: SmartSubject) -> Iterator[Hit]:
    """Exports write +100 for words and double words, 100 for bytes."""
    for _, statement in subject.statements():
        row = MNEMONICS.get(statement.mnemonic)
        for slot, operand in zip(row.slots or () if row else (), statement.operands, strict=False):
            text = subject.text(operand.span)
            if not isinstance(operand, Constant) or operand.pattern or not isinstance(operand.value, int):
                continue
            kind = slot.kind if isinstance(slot, Typed) else None
            if kind in (INT, WORD, DINT, DWORD) and text[0] not in "+-":
                yield operand.span, f"{text} without a sign; Micro/WIN writes word constants as +{text}"
            if kind is BYTE and text[0] in "+-":
                yield operand.span, f"{text} with a sign; Micro/WIN writes byte constants as {text[1:]}"


def right_block(subject: SmartSubject) -> Iterator[Hit]:
    for block, statement in subject.statements():
        if statement.mnemonic in FORBIDDEN[block.kind]:
            yield (
                word_span(statement),
                f"{statement.mnemonic} is not allowed in {_kind(block)}; {_instead(statement, block)}",
            )


_KINDS = {
    BlockKind.INTERRUPT: "an interrupt routine",
    BlockKind.SUBROUTINE: "a subroutine",
    BlockKind.ORGANIZATION: "the main program",
}
_RETURNS = {BlockKind.INTERRUPT: "CRETI", BlockKind.SUBROUTINE: "CRET", BlockKind.ORGANIZATION: "END"}


def _kind(block: Block) -> str:
    return _KINDS[block.kind]


def _instead(statement: Statement, block: Block) -> str:
    return f"write {_RETURNS[block.kind]}" if statement.mnemonic in _RETURNS.values() else "move it to the main program"


# ----------------------------------------------------------------------------------------------------------- shape


def stands_alone(subject: SmartSubject) -> Iterator[Hit]:
    for _, network in subject.networks():
        for statement in network.statements:
            if statement.mnemonic in ALONE and len(network.statements) > 1:
                yield (
                    word_span(statement),
                    f"{statement.mnemonic} stands alone: {LEFT_OUT}; give it a network of its own",
                )
            if statement.mnemonic == "FOR" and _outputs(network) > 1:
                yield word_span(statement), f"FOR needs a network of its own: {LEFT_OUT}; move the rest"


def _outputs(network: Network) -> int:
    return sum(statement.mnemonic in OUTPUTS for statement in network.statements)


@dataclass
class _Level:
    """One level of the logic stack; `load` is the LD it began with, None for a copy of another level."""

    load: Statement | None


@dataclass
class _Rung:
    """A network while it is read: the logic stack, and whether an output was met."""

    levels: list[_Level] = field(default_factory=list)
    first: Statement | None = None
    """The LD that the rung began with."""
    closed: bool = False
    hits: list[Hit] = field(default_factory=list)

    def read(self, statement: Statement) -> None:
        word = statement.mnemonic
        if word in LOADS:
            self.first = self.first or statement
            self._push(statement, _Level(statement))
        elif word in ALONE or word == "NOP" or word not in MNEMONICS:
            return
        elif self._needs(statement) > len(self.levels):
            self._under(statement)
        elif word in ("ALD", "OLD"):
            self._join()
        elif word in ("LPS", "LDS"):
            self._push(statement, _Level(None))
        elif word == "LPP":
            self.levels.pop()
        elif word in OUTPUTS:
            self._output()

    def _needs(self, statement: Statement) -> int:
        return {"ALD": 2, "OLD": 2, "LRD": 2, "LPP": 2, "CTU": 2, "CTD": 2, "CTUD": 3}.get(statement.mnemonic, 1)

    def _push(self, statement: Statement, level: _Level) -> None:
        self.levels.append(level)
        if len(self.levels) == STACK_LEVELS + 1:
            self.hits.append((word_span(statement), f"the logic stack has {STACK_LEVELS} levels; split the network"))

    def _under(self, statement: Statement) -> None:
        word, wanted = statement.mnemonic, self._needs(statement)
        if not self.levels:
            message = f"{word} without a condition before it: {LEFT_OUT}; begin with LD"
        else:
            message = (
                f"{word} needs {wanted} levels of the logic stack, there is {len(self.levels)}: {LEFT_OUT}; add an LD"
            )
        self.hits.append((word_span(statement), message))
        self.levels = [_Level(None)] * wanted  # one message for one mistake

    def _join(self) -> None:
        """The lower level is what the two become."""
        self.levels.pop()

    def _output(self) -> None:
        load = self.levels[-1].load
        if self.closed and load is not None and load is not self.first:
            self.hits.append((word_span(load), f"second rung in one network: {LEFT_OUT}; begin a new network here"))
            self.first = load
        self.closed = True


def one_rung(subject: SmartSubject) -> Iterator[Hit]:
    """An LD behind an output that does not join what stands before it is a rung of its own."""
    return (hit for hit in _rung_hits(subject) if "second rung" in hit[1])


def logic_stack(subject: SmartSubject) -> Iterator[Hit]:
    return (hit for hit in _rung_hits(subject) if "second rung" not in hit[1])


def _rung_hits(subject: SmartSubject) -> Iterator[Hit]:
    for _, network in subject.networks():
        rung = _Rung()
        for statement in network.statements:
            rung.read(statement)
        yield from rung.hits


# ----------------------------------------------------------------------------------------------------------- pairs


def loops(subject: SmartSubject) -> Iterator[Hit]:
    for block in subject.blocks:
        open_loops: list[Statement] = []
        for statement in (item for network in block.networks for item in network.statements):
            if statement.mnemonic == "FOR":
                open_loops.append(statement)
            elif statement.mnemonic == "NEXT" and not open_loops:
                yield word_span(statement), "NEXT without FOR; write FOR above it"
            elif statement.mnemonic == "NEXT":
                open_loops.pop()
        for statement in open_loops:
            yield word_span(statement), "FOR without NEXT; write NEXT in a network of its own"


def labels(subject: SmartSubject) -> Iterator[Hit]:
    for block in subject.blocks:
        statements = [item for network in block.networks for item in network.statements if item.operands]
        places = Counter(subject.text(item.operands[0].span) for item in statements if item.mnemonic == "LBL")
        met: set[str] = set()
        for statement in statements:
            number = subject.text(statement.operands[0].span)
            if statement.mnemonic == "LBL" and number in met:
                yield word_span(statement), f"LBL {number} stands twice in {block.shown}; give one another number"
            if statement.mnemonic == "LBL":
                met.add(number)
            if statement.mnemonic == "JMP" and not places[number]:
                yield word_span(statement), f"no LBL {number} in {block.shown}; a jump stays in its block"
