"""Random STL programs for S7-300, each an FB with its instance: numbers, bits, jumps and pointers, all of them legal.

The generator knows what the accumulators hold, so that REAL instructions meet REAL numbers: the bits of an integer read
as REAL are denormal, and no two engines agree on those.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from random import Random

VARIABLES = {"i": "INT", "d": "DINT", "r": "REAL", "w": "WORD", "e": "DWORD", "b": "BOOL"}
COUNTS = {"i": 4, "d": 4, "r": 4, "w": 4, "e": 4, "b": 8}
TABLE_WORDS = 16
INTERESTING = {
    "i": [0, 1, -1, 2, 7, -13, 255, 256, 32767, -32768, 1000, -999],
    "d": [0, 1, -1, 3, 65535, 65536, -65537, 2147483647, -2147483648, 123456789, -9999999],
}
BITS = "b"
"""What an accumulator holds when it is no REAL."""


@dataclass
class Writer:
    """One program while it is written; `one` and `two` are the kinds in the accumulators: r or b."""

    random: Random
    lines: list[str] = field(default_factory=list)
    labels: int = 0
    one: str = BITS
    two: str = BITS
    depth: int = 0

    def put(self, *instructions: str) -> None:
        self.lines.extend(f"      {instruction};" for instruction in instructions)

    def label(self) -> str:
        self.labels += 1
        return f"M{self.labels:03d}"

    def variable(self, letter: str) -> str:
        return f"#{letter}{self.random.randrange(COUNTS[letter])}"

    def choose(self, words: str) -> str:
        return self.random.choice(words.split())

    # ----------------------------------------------------------------------------------------------------- values

    def load(self, letter: str = "") -> None:
        letter = letter or self.random.choice("iidderrrw")
        plain = letter in "we" or self.random.random() < 0.6
        self.put(f"L {self.variable(letter) if plain else constant(self.random, letter)}")
        self.one, self.two = "r" if letter == "r" else BITS, self.one

    def store(self) -> None:
        letter = "r" if self.one == "r" else self.random.choice("iddwe")
        self.put(f"T {self.variable(letter)}")

    def pair(self, letter: str) -> None:
        """Two values that fit an instruction on both accumulators."""
        if letter == "r":
            if self.one != "r":
                self.load("r")
            if self.two != "r" or self.random.random() < 0.5:
                self.load("r")
        elif self.random.random() < 0.6:
            self.load(letter)
            if self.random.random() < 0.7:
                self.load(letter)


def constant(random: Random, letter: str) -> str:
    if letter == "r":
        return f"{random.choice([0.0, 1.0, -1.0, 0.5, -2.5, 3.5, random.uniform(-50, 50)]):.6e}"
    value = random.choice(INTERESTING[letter] if random.random() < 0.6 else [random.randint(-3000, 3000)])
    return f"L#{value}" if letter == "d" else str(value)


def value(random: Random, letter: str) -> str:
    """An initial value of a variable."""
    if letter == "b":
        return random.choice(["TRUE", "FALSE"])
    if letter == "w":
        return f"W#16#{random.getrandbits(16):X}"
    if letter == "e":
        return f"DW#16#{random.getrandbits(32):X}"
    return constant(random, letter)


# -------------------------------------------------------------------------------------------------------- snippets


def integers(w: Writer) -> None:
    w.pair("i")
    w.put(w.choose("+I -I *I /I"))
    w.one = BITS


def doubles(w: Writer) -> None:
    w.pair("d")
    w.put(w.choose("+D -D *D /D MOD"))
    w.one = BITS


def reals(w: Writer) -> None:
    w.pair("r")
    word = w.choose("+R -R *R +R -R *R /R")
    if word == "/R":
        w.put(f"L {w.random.choice([-4.0, 0.75, 3.0, 7.5]):.6e}")
        w.one, w.two = "r", w.one
    w.put(word)
    w.store()


def real_function(w: Writer) -> None:
    """Only where the result is tame: SIN of numbers far from the axes, EXP of small ones."""
    word = w.choose("ABS NEGR SQR SQRT EXP LN SIN COS TAN ASIN ACOS ATAN")
    number = w.random.uniform(0.2, 0.9)
    if word in ("ABS", "NEGR") and w.one == "r":
        w.put(word)
        return
    w.put(f"L {number:.6e}", word)
    w.one, w.two = "r", w.one
    w.store()


def comparison(w: Writer) -> None:
    letter = w.random.choice("idr")
    w.pair(letter)
    w.put(w.choose("== <> > < >= <=") + {"i": "I", "d": "D", "r": "R"}[letter])
    if w.random.random() < 0.6:
        w.put(f"= {w.variable('b')}")


def conversion(w: Writer) -> None:
    kind = w.random.randrange(5)
    if kind == 0:
        number = w.random.choice([w.random.randint(-9, 9) + 0.5, w.random.uniform(-99, 99)])
        w.put(f"L {number:.6e}", w.choose("RND TRUNC RND+ RND-"), f"T {w.variable('d')}")
        w.two = w.one
    elif kind == 1:
        w.load("i")
        w.put("ITD", "DTR")
    elif kind == 2:
        w.load(w.random.choice("id"))
        w.put("ITD" if w.random.random() < 0.5 else "NOP 0")
    elif kind == 3:
        w.load(w.random.choice("id"))
        w.put(w.choose("INVI INVD NEGI NEGD ITB DTB"))
    else:
        number = w.random.randint(0, 999)
        w.put(f"L {w.random.choice([number, -number])}", "ITB", "BTI")
        w.two = w.one
    w.one = "r" if kind == 1 else BITS


def shift(w: Writer) -> None:
    word = w.choose("SLW SRW SSI SLD SRD SSD RLD RRD")
    if w.random.random() < 0.5:
        w.load(w.random.choice("idwe"))
        most = 15 if word in ("SLW", "SRW", "SSI") else 32
        w.put(f"{word} {w.random.randint(0, most)}")
    else:
        most = 16 if word in ("SLW", "SRW", "SSI") else 32
        w.put(f"L {w.random.choice([0, 1, 7, 15, 16, most - 1, most])}")
        w.two = w.one
        w.load(w.random.choice("idwe"))
        w.put(word)
    w.one = BITS


def word_logic(w: Writer) -> None:
    w.pair(w.random.choice("idwe") if w.random.random() < 0.3 else "i")
    word = w.choose("AW OW XOW AD OD XOD")
    mask = f" DW#16#{w.random.getrandbits(32):X}" if word[-1] == "D" else f" W#16#{w.random.getrandbits(16):X}"
    w.put(word + (mask if w.random.random() < 0.5 else ""))
    w.one = BITS


def accumulators(w: Writer) -> None:
    word = w.choose("TAK PUSH POP CAW CAD INC DEC + RLDA RRDA")
    if word in ("INC", "DEC"):
        word += f" {w.random.randint(0, 255)}"
    if word == "+":
        word += (
            f" {w.random.choice([3, -4, 32767])}" if w.random.random() < 0.5 else f" L#{w.random.randint(-9, 70000)}"
        )
    w.put(word)
    if word == "TAK":
        w.one, w.two = w.two, w.one
    elif word == "PUSH":
        w.two = w.one
    else:
        w.one = w.two if word == "POP" else BITS


def bit(w: Writer) -> str:
    if w.random.random() < 0.2:
        return w.choose("OV OS BR ==0 >0 <0 >=0 <=0 UO")
    return w.variable("b")


def logic(w: Writer) -> None:
    for _ in range(w.random.randint(1, 4)):
        choice = w.random.random()
        if choice < 0.5 or w.depth > 3:
            w.put(f"{w.choose('A AN O ON X XN')} {bit(w)}")
        elif choice < 0.8:
            w.depth += 1
            w.put(w.choose("A( AN( O( ON( X( XN("))
            w.put(f"{w.choose('A AN O ON X')} {bit(w)}")
            logic_inside(w)
            w.put(")")
            w.depth -= 1
        elif choice < 0.9:
            and_before_or(w)
        else:
            w.put(w.choose("NOT SET CLR SAVE"))
    finish_logic(w)


def logic_inside(w: Writer) -> None:
    for _ in range(w.random.randint(0, 2)):
        w.put(f"{w.choose('A AN O ON X XN')} {bit(w)}")


def and_before_or(w: Writer) -> None:
    w.put(f"{w.choose('A AN')} {bit(w)}", "O")
    for _ in range(w.random.randint(1, 3)):
        w.put(f"{w.choose('A AN')} {bit(w)}")


def finish_logic(w: Writer) -> None:
    word = w.choose("= S R FP FN")
    w.put(f"{word} {w.variable('b')}")
    if word in ("FP", "FN"):
        w.put(f"= {w.variable('b')}")


def join(w: Writer, before: tuple[str, str]) -> None:
    """Behind a label an accumulator is REAL only when it is along both ways."""
    w.one = w.one if w.one == before[0] else BITS
    w.two = w.two if w.two == before[1] else BITS


def branch(w: Writer) -> None:
    label = w.label()
    w.put(f"{w.choose('JU JC JCN JCB JNB JBI JNBI JO JOS JZ JN JP JM JPZ JMZ JUO JC JCN')} {label}")
    before = w.one, w.two
    body(w, w.random.randint(1, 3))
    w.lines.append(f"{label}: NOP 0;")
    join(w, before)


def loop(w: Writer) -> None:
    label = w.label()
    w.put(f"L {w.random.randint(1, 4)}")
    w.lines.append(f"{label}: T #n;")
    w.one, w.two = BITS, BITS
    body(w, w.random.randint(1, 2), loops=False)
    w.put("L #n", f"LOOP {label}")
    w.one, w.two = BITS, w.one


def distributor(w: Writer) -> None:
    behind, ways = w.label(), [w.label() for _ in range(w.random.randint(1, 3))]
    end = w.label()
    w.put(f"L {w.random.randint(0, len(ways))}", f"JL {behind}")
    w.two, w.one = w.one, BITS
    w.put(*(f"JU {way}" for way in ways))
    w.lines.append(f"{behind}: JU {end};")
    for way in ways:
        w.lines.append(f"{way}: NOP 0;")
        w.one, w.two = BITS, BITS
        body(w, 1)
        w.put(f"JU {end}")
    w.lines.append(f"{end}: NOP 0;")
    w.one, w.two = BITS, BITS


def pointer(w: Writer) -> None:
    """The table lies in a data block of its own."""
    place = w.random.randrange(TABLE_WORDS - 4) * 2
    offset = w.random.randrange(4) * 2
    size, kind = w.random.choice([("W", "i"), ("D", "d"), ("B", "i")])
    room = f"DB{size} [AR1,P#{offset if size != 'D' else min(offset, 2)}.0]"
    w.put("OPN DB {table}", f"LAR1 P#{place}.0")
    if w.random.random() < 0.3:
        w.put("+AR1 P#2.0")
        room = f"DB{size} [AR1,P#0.0]"
    if w.random.random() < 0.5:
        w.put(f"L {room}")
        w.one, w.two = BITS, w.one
    else:
        w.load(kind)
        w.put(f"T {room}")
    if w.random.random() < 0.4:
        w.put("TAR1 #e0", "L #e0", "LAR1", f"A DBX [AR1,P#1.{w.random.randrange(8)}]", f"= {w.variable('b')}")
        w.one, w.two = BITS, w.one


def pointer_in_memory(w: Writer) -> None:
    place = w.random.randrange(TABLE_WORDS - 2) * 2
    w.put("OPN DB {table}", f"L P#{place}.0", "T MD 0")
    w.two, w.one = w.one, BITS
    if w.random.random() < 0.5:
        w.put(f"L DB{w.choose('B W D')} [MD 0]")
        w.one, w.two = BITS, w.one
    else:
        w.load("d")
        w.put("T DBD [MD 0]")


def temporary(w: Writer) -> None:
    """Written before it is read, since what it holds at first is nobody's business."""
    name = w.choose("#tr #ts") if w.one == "r" else w.choose("#td #te #tw")
    kept = BITS if w.one != "r" else "r"
    w.put(f"T {name}")
    if w.depth < 4:
        body(w, 1)
        if kept == "r" or w.random.random() < 0.5:  # what lies between may have written it again, with its own kind
            w.put(f"L {name}")
            w.one, w.two = kept, w.one


def call(w: Writer) -> None:
    """An FC that works on the accumulators it finds."""
    w.put("UC FC {number}" if w.random.random() < 0.6 else "CC FC {number}")
    w.one, w.two = BITS, BITS
    if w.random.random() < 0.3:
        w.put(f"= {w.variable('b')}")


SNIPPETS: list[tuple[Callable[[Writer], None], int]] = [
    (integers, 4),
    (doubles, 4),
    (reals, 6),
    (real_function, 2),
    (comparison, 4),
    (conversion, 4),
    (shift, 3),
    (word_logic, 3),
    (accumulators, 3),
    (logic, 5),
    (branch, 5),
    (loop, 1),
    (distributor, 1),
    (pointer, 2),
    (pointer_in_memory, 1),
    (temporary, 2),
    (call, 1),
]


def body(w: Writer, count: int, loops: bool = True) -> None:
    w.depth += 1
    usable = [(s, weight) for s, weight in SNIPPETS if w.depth < 4 or s not in (branch, loop, distributor)]
    usable = usable if loops else [(s, weight) for s, weight in usable if s is not loop]
    snippets, weights = zip(*usable, strict=True)
    for snippet in w.random.choices(snippets, weights, k=count):
        snippet(w)
        if w.random.random() < 0.4:
            w.store()
    w.depth -= 1


# -------------------------------------------------------------------------------------------------------- programs


def program(random: Random, number: int) -> str:
    """An FB of this number with its instance, both complete."""
    w = Writer(random)
    w.put("CLR", "SAVE", f"L {constant(random, 'd')}", f"L {constant(random, 'd')}", "LAR1 P#0.0")
    body(w, random.randint(3, 7))
    w.put("T #one", "TAK", "T #two", "L STW", "T #stw")
    names = [f"{letter}{place}" for letter, count in COUNTS.items() for place in range(count)]
    declared = "".join(f"  {name} : {VARIABLES[name[0]]} ;\n" for name in names)
    values = "".join(f"  {name} := {value(random, name[0])};\n" for name in names)
    table = "".join(f"  t[{place}] := W#16#{random.getrandbits(16):X};\n" for place in range(TABLE_WORDS))
    return TEXT.format(
        number=number,
        table=number + TABLES,
        declared=declared,
        body="\n".join(w.lines).format(table=number + TABLES, number=number),
        function=function(random),
        values=values,
        last=TABLE_WORDS - 1,
        entries=table,
    )


TABLES = 1000
"""Added to the number of a program gives that of the data block with its table."""

TEXT = """DATA_BLOCK DB {table}
TITLE =
VERSION : 0.1
STRUCT
  t : ARRAY [0 .. {last}] OF WORD ;
END_STRUCT ;
BEGIN
{entries}END_DATA_BLOCK
FUNCTION FC {number} : VOID
TITLE =
VERSION : 0.1
BEGIN
NETWORK
TITLE =
{function}
END_FUNCTION
FUNCTION_BLOCK FB {number}
TITLE =
VERSION : 0.1
VAR
{declared}  n : INT ;
  one : DWORD ;
  two : DWORD ;
  stw : WORD ;
END_VAR
VAR_TEMP
  tr : REAL ;
  ts : REAL ;
  td : DINT ;
  te : DWORD ;
  tw : WORD ;
END_VAR
BEGIN
NETWORK
TITLE =
{body}
END_FUNCTION_BLOCK
DATA_BLOCK DB {number}
TITLE =
VERSION : 0.1
FB {number}
BEGIN
{values}  n := 0;
  one := DW#16#0;
  two := DW#16#0;
  stw := W#16#0;
END_DATA_BLOCK
"""


def function(random: Random) -> str:
    """The body of an FC that knows nothing but accumulators and status bits."""
    w = Writer(random)
    for _ in range(random.randint(1, 4)):
        if random.random() < 0.5:
            accumulators(w)
        else:
            w.put(w.choose("+I -I *I +D -D ==I >D <>D") if random.random() < 0.7 else f"SLW {random.randint(0, 15)}")
    if random.random() < 0.3:
        w.put("SAVE")
    if random.random() < 0.3:
        w.put("BEC", f"L {constant(random, 'i')}")
    return "\n".join(w.lines)


def calls(numbers: range) -> str:
    """OB1, which runs them all."""
    lines = "".join(f"      CALL FB {number} , DB {number} ;\n" for number in numbers)
    return f"ORGANIZATION_BLOCK OB 1\nTITLE =\nVERSION : 0.1\nBEGIN\nNETWORK\nTITLE =\n{lines}END_ORGANIZATION_BLOCK\n"
