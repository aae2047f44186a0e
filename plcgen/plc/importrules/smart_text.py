"""Rules about a whole file for Micro/WIN SMART: bytes, line ends, blocks and their names."""

from __future__ import annotations

import re
from collections.abc import Iterator

from plcgen.plc.importrules.finding import Hit
from plcgen.plc.importrules.smart_subject import SmartSubject
from plcgen.plc.source import BYTE_ORDER_MARK, EIGHT_BIT, UTF_8, Span
from plcgen.plc.stl.syntax import Block, BlockKind

IDENTIFIER_LENGTH = 23
DEPTHS = {BlockKind.ORGANIZATION: 8, BlockKind.INTERRUPT: 4}
"""Subroutines one inside another."""
START = Span(0, 1)

# ---------------------------------------------------------------------------------------------------------- bytes


def no_byte_order_mark(subject: SmartSubject) -> Iterator[Hit]:
    if subject.raw.startswith(BYTE_ORDER_MARK):
        yield START, "Micro/WIN reads the byte order mark as text; save as ANSI or ASCII"


def plain_ascii(subject: SmartSubject) -> Iterator[Hit]:
    """Chinese in GBK is left alone: Micro/WIN SMART is at home in China."""
    match = re.search(r"[^\x00-\x7f]", subject.source.text)
    if match is None:
        return
    if subject.source.encoding == UTF_8:
        yield Span(*match.span()), "UTF-8 character; Micro/WIN reads the code page of the PC, write ASCII"
    elif subject.source.encoding == EIGHT_BIT:
        yield Span(*match.span()), "this character depends on the code page of the PC; ASCII is safe everywhere"


def crlf(subject: SmartSubject) -> Iterator[Hit]:
    bare = [match.start() for match in re.finditer(r"(?<!\r)\n", subject.source.text)]
    if bare:
        yield Span(bare[0], bare[0]), f"{len(bare)} lines end with LF alone, this is the first; save with CRLF"


# --------------------------------------------------------------------------------------------------------- blocks


def head(subject: SmartSubject) -> Iterator[Hit]:
    for block in subject.blocks:
        if block.head == "PROGRAM_BLOCK":
            message = "Micro/WIN imports nothing from PROGRAM_BLOCK and says it went well; write ORGANIZATION_BLOCK"
            yield Span(block.span.start, block.span.start + len(block.head)), message


def one_block(subject: SmartSubject) -> Iterator[Hit]:
    for block in subject.blocks[1:]:
        yield block.span, "Micro/WIN may import the first block of a file alone; write a file for each block"


def block_order(subject: SmartSubject) -> Iterator[Hit]:
    """MAIN replaces the program at import, and a block must be there when another names it."""
    places = {subject.names.absolute_of(block): place for place, block in enumerate(subject.blocks)}
    for place, block in enumerate(subject.blocks):
        if block.kind is BlockKind.ORGANIZATION and place:
            yield block.span, f"{block.shown} replaces the program when it is imported; put it first"
        if block.kind is BlockKind.ORGANIZATION:
            continue
        for callee in dict.fromkeys(subject.callees[subject.names.absolute_of(block)]):
            if places.get(callee, -1) > place:
                name = subject.names.blocks[callee].shown
                yield block.span, f"{block.shown} calls {name}, which stands below; put {name} first"


def identifier_length(subject: SmartSubject) -> Iterator[Hit]:
    for name, span in _names(subject):
        if len(name) > IDENTIFIER_LENGTH:
            yield span, f"{name} has {len(name)} characters; {IDENTIFIER_LENGTH} are the most, shorten it"


def _names(subject: SmartSubject) -> Iterator[tuple[str, Span]]:
    for block in subject.blocks:
        yield block.name, block.span
        yield from ((item.name, item.span) for item in block.declarations)


def local_variables(subject: SmartSubject) -> Iterator[Hit]:
    for block in subject.blocks:
        if block.declarations:
            span = block.declarations[0].span
            yield span, "no export with local variables was seen, an import may drop them; use V memory"


def nesting_depth(subject: SmartSubject) -> Iterator[Hit]:
    for block in subject.blocks:
        most = DEPTHS.get(block.kind)
        if most is None:
            continue
        chain = _deepest(subject, subject.names.absolute_of(block), ())
        if len(chain) - 1 > most:
            yield (
                block.span,
                f"{len(chain) - 1} subroutines inside one another ({_shown(subject, chain)}); {most} are the most",
            )
    yield from _circles(subject)


def _deepest(subject: SmartSubject, name: str, above: tuple[str, ...]) -> tuple[str, ...]:
    """The longest chain of calls that begins at a block; one that comes round ends there."""
    if name in above:
        return above
    chains = [_deepest(subject, callee, (*above, name)) for callee in dict.fromkeys(subject.callees.get(name, ()))]
    return max(chains, key=len, default=(*above, name))


def _circles(subject: SmartSubject) -> Iterator[Hit]:
    for block in subject.blocks:
        name = subject.names.absolute_of(block)
        if name in _reached(subject, name):
            yield block.span, f"{block.shown} calls itself, if by way of others; break the circle"


def _reached(subject: SmartSubject, name: str) -> set[str]:
    """Every block that is called from one, directly or not."""
    reached: set[str] = set()
    pending = list(subject.callees.get(name, ()))
    while pending:
        callee = pending.pop()
        if callee not in reached:
            reached.add(callee)
            pending.extend(subject.callees.get(callee, ()))
    return reached


def _shown(subject: SmartSubject, chain: tuple[str, ...]) -> str:
    blocks: list[Block] = [subject.names.blocks[name] for name in chain]
    return " > ".join(block.shown for block in blocks)
