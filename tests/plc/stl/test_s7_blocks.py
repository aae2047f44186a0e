"""Blocks of S7-300 STL: calls, parameters, what one block hands to another, symbols, both sets of mnemonics."""

from __future__ import annotations

from textwrap import dedent

import pytest

from plcgen.errors import Fault
from plcgen.plc.core import print_function
from plcgen.plc.machine import Machine
from plcgen.plc.source import SourceText
from plcgen.plc.stl.s7_language import Language, detect_language
from plcgen.plc.stl.s7_lowering import lower
from plcgen.plc.stl.s7_parser import parse
from plcgen.plc.stl.s7_registers import SHARED


def machine_of(text: str, symbols: dict[str, str] | None = None, fill: int = 0) -> Machine:
    return Machine(lower(parse(SourceText("f.awl", dedent(text))), symbols or {}), fill)


CALLEE = """
    FUNCTION_BLOCK FB 1
    VAR_INPUT
      x : REAL := 1.000000e+000 ;
      go : BOOL ;
    END_VAR
    VAR_OUTPUT
      y : REAL ;
    END_VAR
    VAR_IN_OUT
      count : INT ;
    END_VAR
    BEGIN
    NETWORK
          A     #go;
          JCN   M001;
          L     #x;
          L     2.0;
          *R    ;
          T     #y;
    M001: L     #count;
          L     1;
          +I    ;
          T     #count;
    END_FUNCTION_BLOCK
    """


def test_call_of_an_fb_takes_parameters_in_and_out() -> None:
    machine = machine_of(
        CALLEE
        + """
    ORGANIZATION_BLOCK OB 1
    BEGIN
    NETWORK
          CALL FB 1 , DB 1 ( // parameters may
               x := MD 10 , // stand on lines of their own
               go := TRUE,
               y := MD 20,
               count := MW 30 );
          CALL FB 1, DB 1 (go := FALSE);
    END_ORGANIZATION_BLOCK
    """
    )
    machine.memory[next(area for area in machine.memory if str(area) == "M")][10:14] = bytes.fromhex("40400000")
    machine.call("OB1")
    assert machine.variable("MD20").get() == 0x40C00000
    assert machine.variable('"DB1".y').get() == 6.0
    assert machine.variable("MW30").get() == 1
    assert machine.variable('"DB1".count').get() == 2


def test_call_of_a_multi_instance() -> None:
    machine = machine_of(
        CALLEE
        + """
    FUNCTION_BLOCK FB 2
    VAR
      first : FB 1;
      second : FB 1;
      total : REAL;
      n : INT;
    END_VAR
    BEGIN
    NETWORK
          CALL #first (x := 2.0, go := TRUE, y := #total, count := #n);
          CALL #second (x := #total, go := TRUE, count := #n);
          L #second.y; T #total;
    END_FUNCTION_BLOCK
    """
    )
    machine.call("FB2", "DB2")
    assert machine.variable("DB2.total").get() == 8.0
    assert machine.variable("DB2.first.y").get() == 4.0
    assert machine.variable("DB2.n").get() == 2


FUNCTION = """
    FUNCTION FC 1 : INT
    VAR_INPUT
      a : INT ;
    END_VAR
    VAR_OUTPUT
      kept : INT ;
    END_VAR
    VAR_IN_OUT
      sum : INT ;
    END_VAR
    VAR_TEMP
      t : INT ;
    END_VAR
    BEGIN
    NETWORK
          L     #a;
          T     #t;
          L     #sum;
          +I    ;
          T     #sum;
          L     #t;
          NEGI  ;
          T     #RET_VAL;
          L     #a;
          L     5;
          >I    ;
          JCN   END;
          L     1;
          T     #kept;
    END:  SET   ;
          SAVE  ;
    END_FUNCTION
    """


def test_call_of_an_fc_leaves_an_output_alone_that_it_does_not_write() -> None:
    machine = machine_of(
        FUNCTION
        + """
    ORGANIZATION_BLOCK OB 1
    BEGIN
    NETWORK
          L     77;
          T     MW 4;
          CALL FC 1 (a := 3, RET_VAL := MW 2, kept := MW 4, sum := MW 6);
          CALL FC 1 (a := 4, RET_VAL := MW 8, kept := MW 10, sum := MW 6);
          CALL FC 1 (a := 9, RET_VAL := MW 8, kept := MW 12, sum := MW 6);
          A     BR;
          =     M 0.0;
    END_ORGANIZATION_BLOCK
    """
    )
    machine.call("OB1")
    words = [machine.variable(f"MW{byte}").get() for byte in (2, 4, 6, 8, 10, 12)]
    assert words == [0xFFFD, 77, 16, 0xFFF7, 0, 1]
    assert machine.variable("M0.0").get() is True


ACCUMULATORS = """
    FUNCTION FC 2 : VOID
    BEGIN
    NETWORK
          L     MW 0;
          +I    ;
          TAK   ;
          SET   ;
          BEU   ;
    END_FUNCTION
    FUNCTION FC 3 : VOID
    BEGIN
    NETWORK
          NOP   0;
    END_FUNCTION
    ORGANIZATION_BLOCK OB 1
    BEGIN
    NETWORK
          L     5;
          T     MW 0;
          L     7;
          UC    FC 2;
          =     M 20.0;
          UC    FC 3;
          T     MW 4;
          TAK   ;
          T     MW 2;
          CLR   ;
          CC    FC 2;
          SET   ;
          L     1;
          L     2;
          CC    FC 2;
          T     MW 6;
    END_ORGANIZATION_BLOCK
    """


def test_accumulators_and_rlo_go_from_block_to_block() -> None:
    machine = machine_of(ACCUMULATORS)
    machine.call("OB1")
    assert [machine.variable(f"MW{byte}").get() for byte in (2, 4, 6)] == [12, 7, 2]
    assert machine.variable("M20.0").get() is True
    assert machine.variable(f'"{SHARED}".ACCU2').get() == 7


def test_registers_that_nobody_reads_are_not_handed_on() -> None:
    program = lower(parse(SourceText("f.awl", dedent(CALLEE))))
    assert SHARED not in program.data_blocks


def test_lowered_text_has_only_what_matters() -> None:
    program = lower(parse(SourceText("f.awl", dedent(CALLEE))))
    assert print_function(program.functions["FB1"]) == (
        "FB1:\n"
        "    %12:BOOL := D[4.0]\n"
        "    if not %12 jump .M001\n"
        "    %17:REAL := D[0.0]\n"
        "    %22:REAL := %17 * 2.0\n"
        "    D[6.0]:REAL := %22\n"
        ".M001:\n"
        "    %28:INT := D[10.0]\n"
        "    %33:INT := %28 + 1\n"
        "    D[10.0]:INT := %33\n"
        "END:\n"
        "    return"
    )


def test_address_registers_in_an_fc() -> None:
    machine = machine_of(
        """
        FUNCTION FC 1 : VOID
        VAR_TEMP
          t : ARRAY [0 .. 3] OF INT ;
        END_VAR
        BEGIN
        NETWORK
              LAR2  P##t;
              +AR2  P#2.0;
              L     21;
              T     W [AR2,P#2.0];
              L     #t[2];
              T     MW 0;
              LAR1  P#M 4.0;
              CAR   ;
              TAR2  MD 8;
              TAR1  AR2;
              LAR1  AR2;
              TAR2  ;
              T     MD 12;
              OPN   DB 1;
              OPN   DI 2;
              CDB   ;
              L     DBLG;
              T     MW 16;
              L     DILG;
              T     MW 18;
        END_FUNCTION
        DATA_BLOCK DB 1
        STRUCT
          a : INT ;
        END_STRUCT ;
        BEGIN
        END_DATA_BLOCK
        DATA_BLOCK DB 2
        STRUCT
          a : DINT ;
        END_STRUCT ;
        BEGIN
        END_DATA_BLOCK
        """
    )
    machine.call("FC1")
    assert machine.variable("MW0").get() == 21
    assert machine.variable("MD8").get() == 0x83000020
    assert machine.variable("MD12").get() == 0x86000010
    assert (machine.variable("MW16").get(), machine.variable("MW18").get()) == (4, 2)


def test_a_pointer_beyond_its_area_stops_the_cpu() -> None:
    machine = machine_of(
        """
        FUNCTION FC 1 : VOID
        BEGIN
        NETWORK
              OPN   DB 1;
              L     DBW [AR1,P#1.0];
              T     MW 0;
        END_FUNCTION
        DATA_BLOCK DB 1
        STRUCT
          a : INT ;
        END_STRUCT ;
        BEGIN
        END_DATA_BLOCK
        """
    )
    with pytest.raises(Fault) as caught:
        machine.call("FC1")
    assert caught.value.message == "FC1: pointer P#1.0: DB1 has no word there (scan 0)"


GERMAN = """
    FUNCTION FC 1 : VOID
    BEGIN
    NETWORK
          U(    ;
          U     E 0.0;
          ON    "Lampe";
          )     ;
          SPBN  M001;
          L     EW 2;
          T     AW 4;
    M001: UN    E 0.1;
          =     A 8.0;
          BEA   ;
    END_FUNCTION
    """


def test_german_mnemonics() -> None:
    assert detect_language(SourceText("f.awl", GERMAN)) is Language.GERMAN
    machine = machine_of(GERMAN, {"Lampe": "M 0.0"})
    machine.variable("I0.0").set(True)
    machine.variable("IW2").set(42)
    machine.call("FC1")
    assert machine.variable("QW4").get() == 42
    assert machine.variable("Q8.0").get() is True


def test_german_addresses_tell_where_no_mnemonic_does() -> None:
    assert detect_language(SourceText("f.awl", "      L     EW 2;\n      T     AW 4;\n")) is Language.GERMAN
    assert detect_language(SourceText("f.awl", "      L     #e1;\n      L     1.0e5;\n // E 0.0;")) is Language.ENGLISH


def test_symbols_name_blocks_and_addresses() -> None:
    machine = machine_of(
        """
        FUNCTION_BLOCK "Drive"
        VAR_INPUT
          speed : REAL ;
        END_VAR
        VAR_OUTPUT
          fast : BOOL ;
        END_VAR
        BEGIN
        NETWORK
              L     #speed;
              L     1.0;
              >R    ;
              =     #fast;
              =     "Lamp";
        END_FUNCTION_BLOCK
        DATA_BLOCK "DriveData"
        "Drive"
        BEGIN
          speed := 2.000000e+000;
        END_DATA_BLOCK
        ORGANIZATION_BLOCK OB 1
        BEGIN
        NETWORK
              CALL "Drive" , "DriveData";
              L     "DriveData".speed;
              T     MD 0;
        END_ORGANIZATION_BLOCK
        """,
        {"Drive": "FB 100", "DriveData": "DB 100", "Lamp": "Q 4.1"},
    )
    machine.call("OB1")
    assert machine.variable("DB100.fast").get() is True
    assert machine.variable('"DriveData".speed').get() == 2.0
    assert machine.variable("Q4.1").get() is True
    assert machine.variable("MD0").get() == 0x40000000


def test_temporaries_hold_what_was_there_before() -> None:
    text = """
        FUNCTION FC 1 : VOID
        VAR_TEMP
          t : WORD ;
        END_VAR
        BEGIN
        NETWORK
              L     #t;
              T     MW 0;
        END_FUNCTION
        """
    machine = machine_of(text, fill=0xAB)
    machine.call("FC1")
    assert machine.variable("MW0").get() == 0xABAB


def test_an_endless_loop_meets_the_watchdog() -> None:
    machine = machine_of("FUNCTION FC 1 : VOID\nBEGIN\nNETWORK\nM1: JU M1;\nEND_FUNCTION\n")
    with pytest.raises(Fault, match="watchdog"):
        machine.call("FC1")


def test_types_and_nested_structures() -> None:
    machine = machine_of(
        """
        TYPE UDT 5
        STRUCT
          a : INT := 3 ;
          b : ARRAY [0 .. 1] OF REAL ;
        END_STRUCT ;
        END_TYPE
        DATA_BLOCK DB 5
        STRUCT
          on : BOOL ;
          u : UDT 5 ;
        END_STRUCT ;
        BEGIN
          u.b[1] := 4.500000e+000;
        END_DATA_BLOCK
        FUNCTION FC 1 : VOID
        BEGIN
        NETWORK
              L     DB5.u.b[1];
              L     DB5.DBD 4;
              +R    ;
              T     "DB5".u.b[0];
              SET   ;
              =     DB5.DBX 0.0;
        END_FUNCTION
        """
    )
    machine.call("FC1")
    assert machine.variable("DB5.u.b[0]").get() == 4.5
    assert machine.variable("DB5.on").get() is True
    assert machine.variable("DB5.u.a").get() == 3
