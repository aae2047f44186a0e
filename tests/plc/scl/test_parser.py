"""Blocks, declarations, statements and expressions of both dialects, as trees written back to short text."""

from __future__ import annotations

import pytest

from plcgen.plc.scl.dialects import CLASSIC, TIA, Dialect
from plcgen.plc.scl.parser import parse
from plcgen.plc.scl.syntax import (
    Address,
    ArraySpec,
    Assignment,
    Binary,
    Block,
    BlockKind,
    Call,
    CallStatement,
    Case,
    Continue,
    Declaration,
    Exit,
    Expression,
    For,
    If,
    Index,
    InitialList,
    InitialValue,
    Literal,
    Member,
    NamedType,
    Region,
    Repeat,
    Repetition,
    Return,
    Scope,
    SectionKind,
    Slice,
    Statement,
    StringSpec,
    StructSpec,
    TypeSpec,
    Unary,
    Variable,
    While,
)
from plcgen.plc.source import SourceText

MARKS = {Scope.PLAIN: "{}", Scope.LOCAL: "#{}", Scope.GLOBAL: '"{}"'}


def short(node: InitialValue | Expression | TypeSpec | Member | Index | Slice) -> str:
    """A tree as text with all its parentheses."""
    match node:
        case Literal(value=value):
            return repr(value)
        case Variable(name=name, scope=scope, selectors=selectors):
            return MARKS[scope].format(name) + "".join(map(short, selectors))
        case Member(name=name):
            return f".{name}"
        case Index(indices=indices):
            return f"[{','.join(map(short, indices))}]"
        case Slice(unit=unit, number=number):
            return f".%{unit}{number}"
        case Address(area=area, size=size, byte=byte, bit=bit):
            return f"%{area}:{size}{byte}.{bit}"
        case Unary(operator=operator, operand=operand):
            return f"({operator} {short(operand)})"
        case Binary(operator=operator, left=left, right=right):
            return f"({short(left)} {operator} {short(right)})"
        case Call(callee=callee, arguments=arguments):
            parts = [
                f"{a.name or ''}{'=>' if a.is_output else ':=' if a.name else ''}{short(a.value)}" for a in arguments
            ]
            return f"{short(callee)}({', '.join(parts)})"
        case Repetition(count=count, values=values):
            return f"{short(count)}x({', '.join(map(short, values))})"
        case InitialList(values=values):
            return f"[{', '.join(map(short, values))}]"
        case NamedType(name=name):
            return name
        case StringSpec(length=length):
            return f"STRING[{short(length) if length else 254}]"
        case ArraySpec(bounds=bounds, element=element):
            return f"ARRAY[{','.join(f'{short(low)}..{short(high)}' for low, high in bounds)}] OF {short(element)}"
        case StructSpec(fields=fields):
            return f"STRUCT({'; '.join(f'{item.name}:{short(item.type)}' for item in fields)})"
    raise AssertionError(node)


def body(text: str, dialect: Dialect = CLASSIC) -> tuple[Statement, ...]:
    (block,) = parse(SourceText("f.scl", f"FUNCTION FC1 : VOID\nBEGIN\n{text}\nEND_FUNCTION"), dialect)
    return block.body


def one(text: str, dialect: Dialect = CLASSIC) -> Statement:
    (statement,) = body(text, dialect)
    return statement


def block(text: str, dialect: Dialect = CLASSIC) -> Block:
    (found,) = parse(SourceText("f.scl", text), dialect)
    return found


def declarations(text: str, dialect: Dialect = CLASSIC) -> tuple[Declaration, ...]:
    found = block(f"FUNCTION_BLOCK FB1\nVAR\n{text}\nEND_VAR\nBEGIN\nEND_FUNCTION_BLOCK", dialect)
    return found.sections[0].declarations


# ---------------------------------------------------------------------------------------------------- expressions


@pytest.mark.parametrize(
    ("text", "tree"),
    [
        ("a + b * c", "(a + (b * c))"),
        ("a - b - c", "((a - b) - c)"),
        ("a / b * c", "((a / b) * c)"),
        ("a MOD b DIV c", "((a MOD b) DIV c)"),
        ("-x ** 2", "(- (x ** 2))"),
        ("-2 ** 2", "(- (2 ** 2))"),
        ("-2 * 3", "(-2 * 3)"),
        ("a ** -b", "(a ** (- b))"),
        ("a ** b ** c", "((a ** b) ** c)"),
        ("a * -b", "(a * (- b))"),
        ("NOT a AND b", "((NOT a) AND b)"),
        ("NOT a = b", "((NOT a) = b)"),
        ("a OR b XOR c AND d", "(a OR (b XOR (c AND d)))"),
        ("a & b or c", "((a AND b) OR c)"),
        ("a AND b = c", "(a AND (b = c))"),
        ("a = b < c", "(a = (b < c))"),
        ("a < b + 1", "(a < (b + 1))"),
        ("a <> b >= c", "(a <> (b >= c))"),
        ("(a + b) * c", "((a + b) * c)"),
        ("a.b[i, j + 1].c", "a.b[i,(j + 1)].c"),
        ('"Db".x', '"Db".x'),
        ("DB100.out", "DB100.out"),
        ("x.MW1", "x.MW1"),
        ("x.TO", "x.TO"),
        ("OK", "OK"),
        ("ABS(-1.0)", "ABS(-1.0)"),
        ("LIMIT(MN := 0.0, IN := x, MX := 1.0)", "LIMIT(MN:=0.0, IN:=x, MX:=1.0)"),
        ("f()", "f()"),
        ("M0.1", "%M:X0.1"),
        ("E4.7", "%I:X4.7"),
        ("AW2", "%Q:W2.0"),
        ("PEW256", "%PI:W256.0"),
        ("%MD8", "%M:D8.0"),
        ("%IW4:P", "%PI:W4.0"),
        ("DB100.DBD4", "%DB100:D4.0"),
        ("DB100.DX0.1", "%DB100:X0.1"),
        ("DB100.D0.1", "%DB100:X0.1"),
        ("DB7.DW2", "%DB7:W2.0"),
        ("DB7.DBB2", "%DB7:B2.0"),
    ],
)
def test_expressions(text: str, tree: str) -> None:
    statement = one(f"y := {text};")
    assert isinstance(statement, Assignment)
    assert short(statement.value) == tree


def test_tia_spellings() -> None:
    statement = one('y := #a.%X3 OR "Db".b[#i] OR #"two words" OR MW1;', TIA)
    assert isinstance(statement, Assignment)
    assert short(statement.value) == '(((#a.%X3 OR "Db".b[#i]) OR #two words) OR MW1)'


def test_spans_cover_what_they_mean() -> None:
    source = SourceText("f.scl", "FUNCTION FC1 : VOID\nBEGIN\ny := a * (b + c.d);\nEND_FUNCTION")
    (statement,) = parse(source, CLASSIC)[0].body
    assert isinstance(statement, Assignment)
    assert isinstance(statement.value, Binary)
    texts = [source.text[span.start : span.end] for span in (statement.span, statement.value.operator_span)]
    assert texts == ["y := a * (b + c.d)", "*"]
    assert str(source.location(statement.value.right.span)) == "f.scl:3:11"


# ----------------------------------------------------------------------------------------------------- statements


def test_calls() -> None:
    texts = 'FB100.DB100(in := v); inst(a := 1, b => c); f(); "Db"(x := 1);'
    calls = [short(item.call) for item in body(texts) if isinstance(item, CallStatement)]
    assert calls == ["FB100.DB100(in:=v)", "inst(a:=1, b=>c)", "f()", '"Db"(x:=1)']


def test_if() -> None:
    found = one("if a then x := 1; elsif b then ; x := 2; x := 3; ELSE x := 4; end_if;")
    assert isinstance(found, If)
    assert [(short(branch.condition), len(branch.body)) for branch in found.branches] == [("a", 1), ("b", 2)]
    assert len(found.otherwise) == 1


def test_case() -> None:
    found = one("CASE n OF 1, 3..5: x := 1; IDLE: ; -2, LOW..HIGH : y := 1; f(); ELSE: x := 0; END_CASE;")
    assert isinstance(found, Case)
    labels = [
        [short(label.low) + (f"..{short(label.high)}" if label.high else "") for label in branch.labels]
        for branch in found.branches
    ]
    assert labels == [["1", "3..5"], ["IDLE"], ["-2", "LOW..HIGH"]]
    assert [len(branch.body) for branch in found.branches] == [1, 0, 2]
    assert len(found.otherwise) == 1


def test_case_labels_of_tia() -> None:
    found = one('CASE #n OF #IDLE: #x := 1; "RUN": REGION a\n;\nEND_REGION INT#3: ; END_CASE;', TIA)
    assert isinstance(found, Case)
    assert [short(branch.labels[0].low) for branch in found.branches] == ["#IDLE", '"RUN"', "3"]


def test_loops() -> None:
    texts = """
        FOR i := 1 TO n + 1 BY -2 DO EXIT; END_FOR;
        FOR i := 1 TO 2 DO ; END_FOR;
        WHILE a DO CONTINUE; END_WHILE;
        REPEAT RETURN; UNTIL b END_REPEAT;
    """
    stepped, plain, loop, repeat = body(texts)
    assert isinstance(stepped, For)
    assert stepped.step is not None
    assert (short(stepped.variable), short(stepped.end), short(stepped.step)) == ("i", "(n + 1)", "-2")
    assert isinstance(stepped.body[0], Exit)
    assert isinstance(plain, For)
    assert plain.step is None
    assert isinstance(loop, While)
    assert isinstance(loop.body[0], Continue)
    assert isinstance(repeat, Repeat)
    assert isinstance(repeat.body[0], Return)


def test_regions_have_free_names() -> None:
    found = one("REGION it's (* me\n#x += 1.0;\nREGION b\nEND_REGION;\nEND_REGION", TIA)
    assert isinstance(found, Region)
    assert (found.name, len(found.body)) == ("it's (* me", 2)


def test_a_classic_variable_may_be_called_region() -> None:
    assert isinstance(one("region := 1;"), Assignment)


@pytest.mark.parametrize("operator", ["+", "-", "*", "/"])
def test_compound_assignment(operator: str) -> None:
    found = one(f"#x {operator}= 2;", TIA)
    assert isinstance(found, Assignment)
    assert found.operator == operator


def test_empty_statements_leave_nothing() -> None:
    assert body(";;;") == ()


# --------------------------------------------------------------------------------------------------- declarations


@pytest.mark.parametrize(
    ("text", "spec", "initial"),
    [
        ("x : real;", "REAL", None),
        ("x : REAL := 1.5;", "REAL", "1.5"),
        ("x : INT := -1;", "INT", "-1"),
        ("x : tod := TOD#1:0:0;", "TIME_OF_DAY", "3600000"),
        ("x : DT;", "DATE_AND_TIME", None),
        ("x : STRING[20] := 'ab';", "STRING[20]", "'ab'"),
        ("x : STRING;", "STRING[254]", None),
        ("x : UDT5;", "UDT5", None),
        ('x : "Point";', "Point", None),
        ("x : FB20;", "FB20", None),
        ("x : ARRAY[1..3] OF INT := 1, 2, 3;", "ARRAY[1..3] OF INT", "[1, 2, 3]"),
        ("x : ARRAY[1..3] OF INT := [1, 2, 3];", "ARRAY[1..3] OF INT", "[1, 2, 3]"),
        ("x : ARRAY[1..3] OF REAL := 3(0.0);", "ARRAY[1..3] OF REAL", "[3x(0.0)]"),
        ("x : ARRAY[1..N] OF REAL := N(0.0);", "ARRAY[1..N] OF REAL", "[Nx(0.0)]"),
        ("x : ARRAY[1..4] OF REAL := 1.0, 2(0.0, 1.0);", "ARRAY[1..4] OF REAL", "[1.0, 2x(0.0, 1.0)]"),
        ("x : ARRAY[0..1, -2..N+1] OF BOOL := 2(2(TRUE));", "ARRAY[0..1,-2..(N + 1)] OF BOOL", "[2x(2x(True))]"),
        ("x : ARRAY[0..1] OF INT := [[1], [2]];", "ARRAY[0..1] OF INT", "[[1], [2]]"),
        ("x : STRUCT a, b : INT; c : STRUCT d : BOOL; END_STRUCT; END_STRUCT;",
         "STRUCT(a:INT; b:INT; c:STRUCT(d:BOOL))", None),
        ("x : STRUCT a : INT; END_STRUCT", "STRUCT(a:INT)", None),
        ("x : ARRAY[0..1] OF STRUCT a : INT; END_STRUCT;", "ARRAY[0..1] OF STRUCT(a:INT)", None),
    ],
)  # fmt: skip
def test_declarations(text: str, spec: str, initial: str | None) -> None:
    (found,) = declarations(text)
    assert (short(found.type), found.initial and short(found.initial)) == (spec, initial)


def test_several_names_attributes_and_views() -> None:
    a, b, view = declarations("a { S7_x := 'v'; S7_y := 'w' }, b : DWORD; v AT b : ARRAY[0..31] OF BOOL;")
    assert [item.name for item in (a, b, view)] == ["a", "b", "v"]
    assert (a.attributes, b.attributes) == ((("S7_x", "v"), ("S7_y", "w")), ())
    assert (a.view_of, view.view_of) == (None, "b")


def test_quoted_names_and_wide_types_of_tia() -> None:
    first, second = declarations('"two words" : Int; x : LReal;', TIA)
    assert (first.name, short(second.type)) == ("two words", "LREAL")


def test_sections_and_their_retention() -> None:
    found = block(
        """FUNCTION_BLOCK FB1
        VAR_INPUT a : INT; END_VAR  VAR_OUTPUT b : INT; END_VAR  VAR_IN_OUT c : INT; END_VAR
        VAR RETAIN d : INT; END_VAR  VAR NON_RETAIN e : INT; END_VAR  VAR_TEMP f : INT; END_VAR
        END_FUNCTION_BLOCK"""
    )
    assert [(section.kind, section.retain) for section in found.sections] == [
        (SectionKind.INPUT, False),
        (SectionKind.OUTPUT, False),
        (SectionKind.IN_OUT, False),
        (SectionKind.STATIC, True),
        (SectionKind.STATIC, False),
        (SectionKind.TEMP, False),
    ]


def test_constants_of_both_dialects() -> None:
    classic = block("FUNCTION FC1 : VOID CONST N := 3; M := 2 * N; END_CONST BEGIN END_FUNCTION")
    tia = block('FUNCTION "F" : Void VAR CONSTANT N : Int := 3; END_VAR BEGIN END_FUNCTION', TIA)
    assert [(item.name, short(item.value), item.type) for item in classic.constants] == [
        ("N", "3", None),
        ("M", "(2 * N)", None),
    ]
    assert [(item.name, item.type and short(item.type)) for item in tia.constants] == [("N", "INT")]


# --------------------------------------------------------------------------------------------------------- blocks


def test_several_blocks_keep_their_order() -> None:
    text = """
        TYPE UDT1 STRUCT x : REAL; END_STRUCT; END_TYPE
        FUNCTION FC1 : REAL  VAR_INPUT a : REAL; END_VAR  FC1 := a; END_FUNCTION
        FUNCTION_BLOCK FB 1 END_FUNCTION_BLOCK
        DATA_BLOCK DB1 FB1 BEGIN END_DATA_BLOCK
        ORGANIZATION_BLOCK OB35 BEGIN FB1.DB1(); END_ORGANIZATION_BLOCK
    """
    found = parse(SourceText("f.scl", text), CLASSIC)
    assert [(item.kind, item.name) for item in found] == [
        (BlockKind.UDT, "UDT1"),
        (BlockKind.FC, "FC1"),
        (BlockKind.FB, "FB1"),
        (BlockKind.DB, "DB1"),
        (BlockKind.OB, "OB35"),
    ]
    assert parse(SourceText("f.scl", " // nothing\n"), CLASSIC) == ()


@pytest.mark.parametrize(
    ("spelling", "spec"),
    [("VOID", None), ("Void", None), ("REAL", "REAL"), ('"Point"', "Point"), ("STRING[9]", "STRING[9]")],
)
def test_function_results(spelling: str, spec: str | None) -> None:
    found = block(f"FUNCTION FC1 : {spelling} BEGIN END_FUNCTION").return_type
    assert (found and short(found)) == spec


def test_classic_header() -> None:
    header = block(
        """FUNCTION_BLOCK FB100
        TITLE = 'speed (* profile'
        { S7_m_c := 'true' }
        VERSION : '1.0'   // first
        AUTHOR : plcgen
        FAMILY : motion
        NAME : hoist
        KNOW_HOW_PROTECT
        VAR x : INT; END_VAR
        BEGIN END_FUNCTION_BLOCK"""
    ).header
    assert (header.title, header.version, header.author) == ("speed (* profile", "1.0", "plcgen")
    assert (header.family, header.name, header.know_how_protect) == ("motion", "hoist", True)
    assert header.attributes == (("S7_m_c", "true"),)


def test_tia_header_with_a_bare_title() -> None:
    found = block(
        'FUNCTION_BLOCK "Fb One"\r\nTITLE = don\'t (* care\r\n'
        "{ S7_Optimized_Access := 'FALSE' }\r\nAUTHOR : 'me'\r\nVERSION : 1.0\r\nBEGIN\r\nEND_FUNCTION_BLOCK",
        TIA,
    )
    assert (found.name, found.quoted) == ("Fb One", True)
    assert (found.header.title, found.header.version, found.header.author) == ("don't (* care", "1.0", "me")


def test_titles_in_and_out_of_quotes() -> None:
    one_line = block("FUNCTION_BLOCK FB1 TITLE = 'a b' VERSION : '1.0' VAR x : INT; END_VAR BEGIN END_FUNCTION_BLOCK")
    assert (one_line.header.title, one_line.header.version, len(one_line.sections)) == ("a b", "1.0", 1)
    bare = block("FUNCTION_BLOCK \"F\"\nTITLE = 'a' b\nBEGIN\nEND_FUNCTION_BLOCK", TIA)
    assert bare.header.title == "'a' b"
    assert block("FUNCTION_BLOCK FB1\nTITLE =\nVERSION : '0.1'\nEND_FUNCTION_BLOCK").header.title == ""


@pytest.mark.parametrize(
    ("text", "instance_of", "values"),
    [
        ("DATA_BLOCK DB202 FB202\nBEGIN x := 1.0; a[2].b := 3; END_DATA_BLOCK", "FB202", 2),
        ("DATA_BLOCK DB1\nTITLE = 'x'\nVERSION : '1.0'\nFB1 BEGIN END_DATA_BLOCK", "FB1", 0),
        ("DATA_BLOCK DB1 UDT1 BEGIN END_DATA_BLOCK", "UDT1", 0),
        (
            'DATA_BLOCK "Db"\n{ S7_x := \'TRUE\' }\nVERSION : 0.1\nNON_RETAIN\n"Fb"\nBEGIN\nx := 1;\nEND_DATA_BLOCK',
            "Fb",
            1,
        ),
    ],
)
def test_instance_data_blocks(text: str, instance_of: str, values: int) -> None:
    found = block(text)
    assert (found.kind, found.instance_of, found.structure) == (BlockKind.DB, instance_of, None)
    assert len(found.body) == values


@pytest.mark.parametrize(
    "text",
    [
        "DATA_BLOCK DB1 STRUCT x : REAL; y : INT; END_STRUCT; BEGIN x := 1.0; END_DATA_BLOCK",
        "DATA_BLOCK DB1 STRUCT x : REAL; y : INT; END_STRUCT END_DATA_BLOCK",
        'DATA_BLOCK "Db"\nVERSION : 0.1\nVAR x : Real; END_VAR VAR RETAIN y : Int; END_VAR BEGIN END_DATA_BLOCK',
    ],
)
def test_shared_data_blocks(text: str) -> None:
    structure = block(text).structure
    assert structure is not None
    assert short(structure) == "STRUCT(x:REAL; y:INT)"


def test_types() -> None:
    found = block('TYPE "Point"\nVERSION : 0.1\nSTRUCT x, y : REAL := 1.0; END_STRUCT;\nEND_TYPE', TIA)
    assert found.structure is not None
    assert short(found.structure) == "STRUCT(x:REAL; y:REAL)"
