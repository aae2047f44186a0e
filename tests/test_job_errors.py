"""Every wrong job ends with one sentence at one place, held here word for word."""

# ruff: noqa: E501 - a message stands in one piece, as the user reads it

from __future__ import annotations

import pytest

from plcgen.errors import JobError
from plcgen.job import parse_job

JOB = """\
name = "MainShaft"
method = "hoist"
targets = ["s7-300-scl", "tia-scl"]
length_unit = "m"
sample_period = 0.010

[hoist]
travel = 600.0
max_velocity = 12.0
acceleration = 0.75
jerk = 0.5
creep_velocity = 0.5
creep_out = 1.5
creep_in = 2.5

[hoist.envelope]
reaction_time = 0.5

[blocks]
fb = 100
"""

TWO_TARGETS = 'targets = ["s7-300-scl", "tia-scl"]'
# What is written in the job above, what a user writes instead, and the place and words of the error.
CASES = [
    ('name = "MainShaft"', "", '1:1: the job lacks name; add a line such as name = "MainShaft"'),
    (
        '"MainShaft"',
        '"NUL"',
        '1:8: name = "NUL" is a device of Windows, which takes no file of that name; write another name',
    ),
    ('"MainShaft"', "5", "1:8: name = 5 is an integer; write a name in quotes"),
    (
        TWO_TARGETS,
        'targets = ["s7-300-stl"]\nmnemonics = "German"',
        '4:13: mnemonics = "German" is unknown; write "german"',
    ),
    (
        TWO_TARGETS,
        'targets = ["s7-300-stl"]\nmnemonics = "french"',
        '4:13: mnemonics = "french" is unknown; write "english" or "german"',
    ),
    (
        TWO_TARGETS,
        f'{TWO_TARGETS}\nmnemonics = "german"',
        '4:13: mnemonics = "german" concerns the target "s7-300-stl" alone; add it to targets, or remove the key',
    ),
    (
        '"MainShaft"',
        '""',
        '1:8: name = "" is no SCL name; begin with a letter, set single underscores and none at the end',
    ),
    (
        '"MainShaft"',
        '"Main Shaft"',
        '1:8: name = "Main Shaft" holds a blank; write letters A-Z, digits and underscores',
    ),
    (
        '"MainShaft"',
        '"Schacht_Süd"',
        '1:8: name = "Schacht_Süd" holds the character ü; write letters A-Z, digits and underscores',
    ),
    ('"MainShaft"', '"主井"', '1:8: name = "主井" holds the character 主; write letters A-Z, digits and underscores'),
    ('"MainShaft"', '"x*)y"', '1:8: name = "x*)y" holds the character *; write letters A-Z, digits and underscores'),
    ('"MainShaft"', '"x\\ny"', '1:8: name = "x\\ny" holds a line end; write letters A-Z, digits and underscores'),
    ('"MainShaft"', "'say\"it'", "1:8: name = 'say\"it' holds a quote; write letters A-Z, digits and underscores"),
    ('"MainShaft"', '"x\'y"', '1:8: name = "x\'y" holds a quote; write letters A-Z, digits and underscores'),
    ('"MainShaft"', '"x\\ty"', '1:8: name = "x\\ty" holds a tab; write letters A-Z, digits and underscores'),
    (
        '"MainShaft"',
        '"x\\u200By"',
        '1:8: name = "x\\u200By" holds the character U+200B; write letters A-Z, digits and underscores',
    ),
    ('"MainShaft"', '"""x\ny"""', '1:8: name = """x ... holds a line end; write letters A-Z, digits and underscores'),
    (
        '"MainShaft"',
        '"_x"',
        '1:8: name = "_x" is no SCL name; begin with a letter, set single underscores and none at the end',
    ),
    (
        '"MainShaft"',
        '"1st"',
        '1:8: name = "1st" is no SCL name; begin with a letter, set single underscores and none at the end',
    ),
    (
        '"MainShaft"',
        '"a__b"',
        '1:8: name = "a__b" is no SCL name; begin with a letter, set single underscores and none at the end',
    ),
    (
        '"MainShaft"',
        '"ab_"',
        '1:8: name = "ab_" is no SCL name; begin with a letter, set single underscores and none at the end',
    ),
    ('"MainShaft"', '"Begin"', '1:8: name = "Begin" is a reserved word of SCL; write another name, such as Begin_1'),
    ('"MainShaft"', '"real"', '1:8: name = "real" is a reserved word of SCL; write another name, such as real_1'),
    ('"MainShaft"', '"sqrt"', '1:8: name = "sqrt" is a reserved word of SCL; write another name, such as sqrt_1'),
    (
        '"MainShaft"',
        '"INT_TO_REAL"',
        '1:8: name = "INT_TO_REAL" is a reserved word of SCL; write another name, such as INT_TO_REAL_1',
    ),
    (
        '"MainShaft"',
        '"FB100"',
        '1:8: name = "FB100" reads as an address; write a name that is not an area and a number',
    ),
    ('"MainShaft"', '"db1"', '1:8: name = "db1" reads as an address; write a name that is not an area and a number'),
    ('"MainShaft"', '"M0"', '1:8: name = "M0" reads as an address; write a name that is not an area and a number'),
    ('"MainShaft"', '"QW4"', '1:8: name = "QW4" reads as an address; write a name that is not an area and a number'),
    ('"MainShaft"', '"T5"', '1:8: name = "T5" reads as an address; write a name that is not an area and a number'),
    (
        '"MainShaft"',
        '"Main"',
        '1:8: name = "Main" is the name of a block that most projects have already; write another name',
    ),
    (
        '"MainShaft"',
        '"MainShaftNumber7"',
        '1:8: name = "MainShaftNumber7" has 16 characters; s7-300-scl takes 15, for MainShaftNumber7_Velocity comes of it',
    ),
    (
        '"MainShaft"',
        "MainShaft",
        '1:8: no value here; write a number such as 12.0, a "text" in quotes, true, or a [list]',
    ),
    ('"MainShaft"', '"MainShaft', "1:8: the text is not closed; end it with a quote"),
    (
        '"MainShaft"',
        "“MainShaft”",
        "1:8: the character “ has no meaning here; write plain ASCII quotes, signs and digits",
    ),
    ('method = "hoist"', "", '1:1: the job lacks method; add a line such as method = "hoist"'),
    ('"hoist"', '"hoits"', '2:10: method = "hoits" is unknown; write "hoist"'),
    ('"hoist"', '"planetary"', '2:10: method = "planetary" is unknown; write "hoist" or "two-axis"'),
    ('"hoist"', '["hoist"]', '2:10: method = ["hoist"] is a list; write "hoist" or "two-axis"'),
    ('"hoist"', "true", '2:10: method = true is a boolean; write "hoist" or "two-axis"'),
    (
        '["s7-300-scl", "tia-scl"]',
        '"tia-scl"',
        '3:11: targets = "tia-scl" is a text; write a list, such as ["s7-300-scl"]',
    ),
    (
        '["s7-300-scl", "tia-scl"]',
        "[]",
        '3:11: targets = [] names no target; write one or more, such as ["s7-300-scl"]',
    ),
    ('["s7-300-scl", "tia-scl"]', '["tia-scl", "tia-scl"]', '3:23: targets[1] = "tia-scl" is listed twice; keep one'),
    ('["s7-300-scl", "tia-scl"]', '["s7-300-sc"]', '3:12: targets[0] = "s7-300-sc" is unknown; write "s7-300-scl"'),
    (
        '["s7-300-scl", "tia-scl"]',
        '["codesys"]',
        '3:12: targets[0] = "codesys" is unknown; write "s7-300-scl", "s7-300-stl", "tia-scl" or "s7-200-smart"',
    ),
    (
        '["s7-300-scl", "tia-scl"]',
        '["tia-scl", 7]',
        '3:23: targets[1] = 7 is an integer; write "s7-300-scl", "s7-300-stl", "tia-scl" or "s7-200-smart"',
    ),
    (
        '["s7-300-scl", "tia-scl"]',
        '["s7-200-smart"]',
        '3:12: targets[0] = "s7-200-smart" does not serve the method "hoist"; '
        'write "s7-300-scl", "s7-300-stl" or "tia-scl"',
    ),
    (
        '["s7-300-scl", "tia-scl"]',
        '["s7-300-scl", "s7-200-smart"]',
        '3:26: targets[1] = "s7-200-smart" does not serve the method "hoist"; remove it',
    ),
    (
        '["s7-300-scl", "tia-scl"]',
        '["tia-scl" "tia-scl"]',
        "3:22: the list is not closed; separate its items by commas and end it with ]",
    ),
    ('"m"', '"inch"', '4:15: length_unit = "inch" is unknown; write "m", "cm" or "mm"'),
    ('"m"', "1", '4:15: length_unit = 1 is an integer; write "m", "cm" or "mm"'),
    ("0.010", "10", "5:17: sample_period = 10 is out of range; write 0.001 to 1 s"),
    ("0.010", "0", "5:17: sample_period = 0 is not positive; write 0.001 to 1 s"),
    ("0.010", "0.0105", "5:17: sample_period = 0.0105 is no whole number of milliseconds; write 0.010 or 0.011"),
    ("0.010", '"10ms"', '5:17: sample_period = "10ms" is a text; write a number without quotes, 0.001 to 1 s'),
    ("0.010", "10ms", "5:19: nothing but a # comment may follow here; decimals take a point, text takes quotes"),
    ("travel = 600.0", "", "7:2: [hoist] lacks travel; add a line such as travel = 600.0"),
    ("600.0", '"600"', '8:10: hoist.travel = "600" is a text; write a number without quotes, 0.1 to 10000 m'),
    ("600.0", "true", "8:10: hoist.travel = true is a boolean; write a number, 0.1 to 10000 m"),
    ("600.0", "-5", "8:10: hoist.travel = -5 is not positive; write 0.1 to 10000 m"),
    ("600.0", "0", "8:10: hoist.travel = 0 is not positive; write 0.1 to 10000 m"),
    ("600.0", "nan", "8:10: hoist.travel = nan is no finite number; write 0.1 to 10000 m"),
    ("600.0", "-inf", "8:10: hoist.travel = -inf is no finite number; write 0.1 to 10000 m"),
    ("600.0", "1e400", "8:10: hoist.travel = 1e400 is no finite number; write 0.1 to 10000 m"),
    ("600.0", "1e9", "8:10: hoist.travel = 1e9 is out of range; write 0.1 to 10000 m"),
    ("600.0", "600,0", "8:13: nothing but a # comment may follow here; decimals take a point, text takes quotes"),
    ("600.0", "600 m", "8:14: nothing but a # comment may follow here; decimals take a point, text takes quotes"),
    ("600.0", "[600]", "8:10: hoist.travel = [600] is a list; write a number, 0.1 to 10000 m"),
    ("600.0", "{ x = 1 }", "8:10: hoist.travel = { x = 1 } is a table; write a number, 0.1 to 10000 m"),
    ("600.0", "2024-05-01", "8:10: hoist.travel = 2024-05-01 is a date or time; write a number, 0.1 to 10000 m"),
    (
        "600.0",
        "10000000000000000000000000000000000000",
        "8:10: hoist.travel = 10000000000000000000000000000000000000 is out of range; write 0.1 to 10000 m",
    ),
    (
        "max_velocity = 12.0",
        "max_velocity = 0.5",
        "12:18: hoist.creep_velocity = 0.5 is above half of max_velocity = 0.5; write at most 0.25",
    ),
    (
        "max_velocity = 12.0",
        "max_velocity = 300",
        "9:16: hoist.max_velocity = 300 is out of range; write 0.01 to 50 m/s",
    ),
    (
        "acceleration = 0.75",
        "acceleration = 0.0",
        "10:16: hoist.acceleration = 0.0 is not positive; write 0.01 to 100 m/s2",
    ),
    ("jerk = 0.5", "jerk = 1e-6", "11:8: hoist.jerk = 1e-6 is out of range; write 0.01 to 1000 m/s3"),
    (
        "creep_out = 1.5",
        "creep_out = 1e-30",
        "13:13: hoist.creep_out = 1e-30 is next to nothing; write 0 to 1000 m, and if not 0 at least 0.000001",
    ),
    ("creep_out = 1.5", "creep_out = -1", "13:13: hoist.creep_out = -1 is out of range; write 0 to 1000 m"),
    ("creep_in = 2.5", "creep_in = 0", "14:12: hoist.creep_in = 0 is not positive; write 0.001 to 1000 m"),
    (
        "creep_in = 2.5",
        "creep_in = 2.5\ncreep_acceleration = 0.8",
        "15:22: hoist.creep_acceleration = 0.8 is above acceleration = 0.75; write at most 0.75",
    ),
    (
        "creep_in = 2.5",
        "creep_in = 2.5\ndeceleration = 1000",
        "15:16: hoist.deceleration = 1000 is out of range; write 0.01 to 100 m/s2",
    ),
    (
        "reaction_time = 0.5",
        "overspeed_factor = 0.9",
        "17:20: hoist.envelope.overspeed_factor = 0.9 is out of range; write 1 to 3",
    ),
    (
        "reaction_time = 0.5",
        "reaction_time = -0.5",
        "17:17: hoist.envelope.reaction_time = -0.5 is out of range; write 0 to 10 s",
    ),
    (
        "reaction_time = 0.5",
        "end_velocity = 0",
        "17:16: hoist.envelope.end_velocity = 0 is not positive; write 0.01 to 50 m/s",
    ),
    ("travel", "travell", "8:1: unknown key hoist.travell; did you mean travel?"),
    ("max_velocity", "MaxVelocity", "9:1: unknown key hoist.MaxVelocity; did you mean max_velocity?"),
    ("jerk", "jerk_limit", "11:1: unknown key hoist.jerk_limit; did you mean jerk?"),
    (
        "reaction_time",
        "colour",
        "17:1: unknown key hoist.envelope.colour; known here: overspeed_factor, tracking_factor, tracking_margin, brake_deceleration, reaction_time, end_velocity, overwind",
    ),
    ("sample_period = 0.010", "", "1:1: the job lacks sample_period; add a line such as sample_period = 0.01"),
    (
        "fb = 100",
        "fb = 100\nsample_period = 0.010",
        "21:1: unknown key blocks.sample_period; sample_period belongs at the top of the file, above the first [table]",
    ),
    ("fb = 100", "travel = 5", "20:1: unknown key blocks.travel; travel belongs in [hoist]"),
    ("name =", "fb = 7\nname =", "1:1: unknown key fb; fb belongs in [blocks]"),
    ("[hoist.envelope]", "[envelope]", "16:2: unknown table [envelope]; did you mean [hoist.envelope]?"),
    ("[blocks]", "[block]", "19:2: unknown table [block]; did you mean [blocks]?"),
    ("[hoist]", "[hois]", "7:2: unknown table [hois]; did you mean [hoist]?"),
    ("[hoist]", "[[hoist]]", "7:3: hoist is a list; write a table, [hoist] and its keys below"),
    (
        "creep_in = 2.5",
        "creep_in = 2.5\ntravel = 5",
        "15:1: key hoist.travel is written twice, first in line 8; keep one of them",
    ),
    ("[blocks]", "[hoist]", "19:2: table [hoist] is written twice, first in line 7; keep one of them"),
    ("name =", "hoist.travel = 5\nname =", "9:1: key hoist.travel is written twice, first in line 1; keep one of them"),
    ("jerk = 0.5", "jerk 0.5", "11:6: = is missing after the key"),
    ("[blocks]", "[blocks", "19:8: the table header is not closed; end it with ]"),
    ("name =", "= 5\nname =", "1:1: no key here; write key = value, or a table header in [ ]"),
    ("fb = 100", 'fb = 100\n"a.b\\n" = 1', "21:1: unknown key blocks.a.b\\n; known here: fb, db, fc, fb_name, db_name"),
    ("fb = 100", "fb = 0", "20:6: blocks.fb = 0 is out of range; write 1 to 7999"),
    ("fb = 100", "fb = 8000", "20:6: blocks.fb = 8000 is out of range; write 1 to 7999"),
    ("fb = 100", "fb = 100.0", "20:6: blocks.fb = 100.0 is a decimal number; write a whole number, 1 to 7999"),
    ("fb = 100", 'fc = "100"', '20:6: blocks.fc = "100" is a text; write a whole number, 1 to 7998'),
    ("fb = 100", "db = 16001", "20:6: blocks.db = 16001 is out of range; write 1 to 16000"),
    (
        "fb = 100",
        'fb_name = "IF"',
        '20:11: blocks.fb_name = "IF" is a reserved word of SCL; write another name, such as IF_1',
    ),
    (
        "fb = 100",
        'fb_name = "MainShaftNumber7"',
        '20:11: blocks.fb_name = "MainShaftNumber7" has 16 characters; s7-300-scl takes 15, for MainShaftNumber7_Velocity comes of it',
    ),
    (
        "fb = 100",
        'fb_name = "Hoist"\ndb_name = "HOIST"',
        '21:11: blocks.db_name = "HOIST" names another block too, Hoist; write another name',
    ),
    (
        "fb = 100",
        'db_name = "MainShaft_Travel"',
        '20:11: blocks.db_name = "MainShaft_Travel" names another block too, MainShaft_Travel; write another name',
    ),
    (
        "fb = 100",
        'db_name = "TheDataOfTheMainShaft_1_2"',
        '20:11: blocks.db_name = "TheDataOfTheMainShaft_1_2" has 25 characters; s7-300-scl takes 24',
    ),
    ("[blocks]\nfb = 100", "blocks = 5", "19:1: unknown key hoist.envelope.blocks; did you mean [blocks]?"),
    (
        "fb = 100",
        'fb_name = "Hoist"\nfb_name = "Hoist"',
        "21:1: key blocks.fb_name is written twice, first in line 20; keep one of them",
    ),
    ("fb = 100", 'fb = 100\nx = "\x07"', "21:6: a control character has no place here; remove it"),
    (
        "fb = 100",
        'fb = 100\nx = "C:\\plc"',
        "21:10: a backslash starts an escape; write two of them, or the text in 'single' quotes",
    ),
    ("fb = 100", "fb = 5\nfb.y = 6", "21:9: the key is written before, as a value or as a table; keep one of them"),
    ("fb = 100", "fb = [1, 2", "20:11: the list is not closed; separate its items by commas and end it with ]"),
    ("fb = 100", "fb = { y = 1", "20:13: the table is not closed; separate its keys by commas and end it with }"),
    ("fb = 100", 'fb = """x', "20:10: the text is not closed; end it with a quote"),
    ("[hoist]", "[[hoist]", "7:8: the table header is not closed; end it with ]]"),
]


@pytest.mark.parametrize(("right", "wrong", "message"), CASES)
def test_error(right: str, wrong: str, message: str) -> None:
    assert right in JOB
    with pytest.raises(JobError) as caught:
        parse_job(JOB.replace(right, wrong, 1), "job.toml")
    assert str(caught.value).split("\n")[0] == f"job.toml:{message}"
