"""What names mean in a program: blocks, system symbols, symbols of the user."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence

from plcgen.plc.source import Span
from plcgen.plc.stl.operands import read_address
from plcgen.plc.stl.smart_symbols import SYSTEM_SYMBOLS
from plcgen.plc.stl.syntax import Address, Block, BlockKind, Declaration
from plcgen.plc.suggest import did_you_mean

ALIASES = {"MAIN": "OB1"}


class Names:
    """Blocks by their absolute names, and symbols; all in any case of letters."""

    def __init__(self, blocks: Sequence[Block], symbols: Mapping[str, str]) -> None:
        self.blocks: dict[str, Block] = {}
        self._absolute: dict[str, str] = {}
        for block in _numbered_first(blocks):
            self._enter(block)
        given = {name.strip('"'): address for name, address in symbols.items()}
        self._symbols = {name.casefold(): address for name, address in {**SYSTEM_SYMBOLS, **given}.items()}
        self._spelling = [*SYSTEM_SYMBOLS, *given]

    def _enter(self, block: Block) -> None:
        absolute = f"{block.kind.value}{self._number(block)}"
        if absolute in self.blocks:
            other = self.blocks[absolute].source.location(self.blocks[absolute].span)
            raise block.source.error(f"{absolute} stands in {other} too; give one of them another number", block.span)
        self.blocks[absolute] = block
        self._absolute[absolute.casefold()] = absolute
        if block.name:
            self._absolute.setdefault(block.name.casefold(), absolute)

    def _number(self, block: Block) -> int:
        """An export may lack the number: the next free one then."""
        if block.kind is BlockKind.ORGANIZATION:
            return 1
        if block.number is not None:
            return block.number
        return next(n for n in range(len(self.blocks) + 1) if f"{block.kind.value}{n}" not in self.blocks)

    @property
    def symbols(self) -> dict[str, str]:
        """All that a machine may be asked for, in lower case."""
        aliases = {alias.casefold(): name for alias, name in ALIASES.items() if name in self.blocks}
        return {**self._symbols, **aliases, **self._absolute}

    def absolute_of(self, block: Block) -> str:
        return next(name for name, known in self.blocks.items() if known is block)

    def block(self, name: str, kind: BlockKind) -> str | None:
        """The absolute name of a block called by its name, its absolute name or its bare number."""
        wanted = f"{kind.value}{name}" if name.isdecimal() else self._symbols.get(name.casefold(), name)
        absolute = self._absolute.get(wanted.casefold())
        return absolute if absolute and self.blocks[absolute].kind is kind else None

    def blocks_near(self, name: str, kind: BlockKind) -> str:
        """`; did you mean ...?` or what there is."""
        known = [block.name or key for key, block in self.blocks.items() if block.kind is kind]
        return did_you_mean(name, known) or (f"; there is {', '.join(known)}" if known else "")

    def address(self, name: str, span: Span) -> Address | None:
        text = self._symbols.get(name.casefold())
        return read_address(text, span) if text else None

    def near(self, name: str, own: Iterable[str]) -> str:
        return did_you_mean(name, [*own, *self._spelling])


def _numbered_first(blocks: Sequence[Block]) -> list[Block]:
    return sorted(blocks, key=lambda block: block.number is None)


def declared(declarations: Sequence[Declaration], name: str) -> Declaration | None:
    return next((item for item in declarations if item.name.casefold() == name.casefold()), None)
