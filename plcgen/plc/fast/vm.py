"""The virtual machine. Written by `generate.py`: change that, not this.

`code` holds an instruction a row: number, target, four operands, six numbers and the site. All but memory, M, lies in
one piece, `room`: the state, counters, the stack of calls, events, and behind them the slots, seen as integers in I and
as floats in F. It ends with what it needs: nothing, an operator that Python has to evaluate, room for events; or
because the budget is spent.
"""

from typing import Any

import numpy as np
from numba import njit

from plcgen.plc.fast.helpers import *

HELPERS = "aaecaa514acfc2c8"
"""Beginning of the SHA-256 of helpers.py. Numba compiles anew when a file has changed, not when what it calls has."""
DONE, REQUEST, EXHAUSTED, FULL, HANDED_OVER = range(5)
"""The last is of native code: the virtual machine goes on from the row that it has noted."""
QUIET = -1
"""Of `enter`: ended, and there is nothing to tell."""
START, BUDGET, CALLS, NATIVE = range(4)
"""Fields of the state; the last is the address of native code, if there is any."""
BASE = 1
"""Slot of the instance's first byte."""
FACTOR = 3
KIND0, KIND1, KIND2, KIND3 = range(4)
ROUNDING0, ROUNDING1, ROUNDING2, ROUNDING3 = range(4)
COUNTS, STACK, EVENTS, SLOTS = 16, 80, 8208, 8208 + 131072
MOST_EVENTS = 30000
"""Noted before Python is told: the others fit between two jumps backwards."""

BODIES = {
    '((A & K0) << K1) + 0 if A >> K2 == K3 and (A & K0) <= K4 else -1 - A|ii|0|R < 0|stop()': 32,
    '((A + B) & K0 ^ K1) - K1|iii|0||': 33,
    '(A & 1) << 1|ii|0||': 34,
    '(A & K0 ^ K1) - K1|ii|0||': 35,
    '(A & K0) + 0|ii|0|R > K1 or R & K2|stop()': 36,
    '(A & K0) + 0|ii|0|R > K1|stop()': 37,
    '(A & K0) + K1|ii|0|R > K2 or R & K3|stop()': 38,
    '(A & K0) + K1|ii|0|R > K2|stop()': 39,
    '(A << (B % K0) | A >> K0 - (B % K0)) & K1|iii|0||': 40,
    '(A << 1 | B >> 1) & K0|iii|0||': 41,
    '(A << B % K0 | A >> K0 - B % K0) & K1|iii|0||': 42,
    '(A << B >> K0 & 1) << 1 if B else C|iiii|0||': 43,
    '(A >> (B % K0) | A << K0 - (B % K0)) & K1|iii|0||': 44,
    '(A >> (B - 1) % K0 & 1) << 1 if B else C|iiii|0||': 45,
    '(A >> (K0 - B) % K0 & 1) << 1 if B else C|iiii|0||': 46,
    '(A >> B % K0 | A << K0 - B % K0) & K1|iii|0||': 47,
    '(A >> B - 1 & 1) << 1 if B else C|iiii|0||': 48,
    '(remainder(E, A, B, site) & K0) << K1 | quotient(E, A, B, site) & K0 if B else noted(E, C, KIND2, site)|iiii|0||': 49,
    '-A|ff|0||': 50,
    '-A|ii|0|not -K0 <= R <= K1|wrap(E, R, -K0, K2, site)': 51,
    '0 if not A or not B else 2 if (A < 0) == (B < 0) else 1|iii|0||': 52,
    '2 if A > 0 else 1 if A < 0 else 0|ii|0||': 53,
    '2 if A > 0.0 else 1 if A < 0.0 else 0 if A == 0.0 else K0|fi|0||': 54,
    '2 if A > B else 1 if A < B else 0 if A == B else K0|ffi|0||': 55,
    '2 if A > B else 1 if A < B else 0|iii|0||': 56,
    '2 if A else 0|ii|0||': 57,
    'A != A or B != B|ffb|0||': 58,
    'A != B|bbb|0||': 59,
    'A != B|iib|0||': 60,
    'A & 1 == 1|ib|0||': 61,
    'A & B|bbb|0||': 62,
    'A & B|iii|0||': 63,
    'A & K0 | (0 if -K1 <= B <= K2 else 2)|iii|0||': 64,
    'A & K0 | (0 if 0 <= B <= K1 else 2)|iii|0||': 65,
    'A & K0 | (1 if B == 0 else 0)|iii|0||': 66,
    'A & K0 | (2 if not -K1 <= B <= K2 else 1 if B == 0 else K3 if B < 0 else 0) if C else A | K4|iiii|0||': 67,
    'A & K0 | (2 if not -K1 <= B <= K2 else 1 if B == 0 else K3 if B < 0 else 0)|iii|0||': 68,
    'A & K0 | (2 if not 0 <= B <= K1 else 1 if B == 0 else K2 if B < 0 else 0) if C else A | K3|iiii|0||': 69,
    'A & K0 | (2 if not 0 <= B <= K1 else 1 if B == 0 else K2 if B < 0 else 0)|iii|0||': 70,
    'A & K0 | (2 if not B - B == 0.0 else 1 if B == 0 else K1 if B < 0 else 0) if C else A | K2|iffi|0||': 71,
    'A & K0 | (2 if not B - B == 0.0 else 1 if B == 0 else K1 if B < 0 else 0)|ifi|0||': 72,
    'A & K0 | A + B & K1|iii|0||': 73,
    'A & K0 | B & K1|iii|0||': 74,
    'A & K0 | B|iii|0||': 75,
    'A & K0|ii|0||': 76,
    'A * A|ff|1|R and not G0 <= R * R <= G1|special(E, R, site)': 77,
    'A * B|fff|1|R and not G0 <= R * R <= G1|special(E, R, site)': 78,
    'A * B|iii|0|not -K0 <= R <= K1|noted(E, R, KIND0, site)': 79,
    'A * B|iii|0|not -K0 <= R <= K1|wrap(E, R, -K0, K2, site)': 80,
    'A * B|iii|0|not 0 <= R <= K0|noted(E, R, KIND0, site)': 81,
    'A * B|iii|0||': 82,
    'A + 0.0|if|0||': 83,
    'A + 0.0|if|1||': 84,
    'A + B & K0|iii|0||': 85,
    'A + B|fff|1|R and not G0 <= R * R <= G1|special(E, R, site)': 86,
    'A + B|iii|0|not -K0 <= R <= K1|noted(E, R, KIND0, site)': 87,
    'A + B|iii|0|not -K0 <= R <= K1|wrap(E, R, -K0, K2, site)': 88,
    'A + B|iii|0|not 0 <= R <= K0|noted(E, R, KIND0, site)': 89,
    'A - B & K0|iii|0||': 90,
    'A - B|fff|1|R and not G0 <= R * R <= G1|special(E, R, site)': 91,
    'A - B|iii|0|not -K0 <= R <= K1|noted(E, R, KIND0, site)': 92,
    'A - B|iii|0|not -K0 <= R <= K1|wrap(E, R, -K0, K2, site)': 93,
    'A - B|iii|0|not 0 <= R <= K0|noted(E, R, KIND0, site)': 94,
    'A / B if B else over_zero(E, A, B)|fff|1|R and not G0 <= R * R <= G1|special(E, R, site)': 95,
    'A < B or A > B|ffb|0||': 96,
    'A < B|ffb|0||': 97,
    'A < B|iib|0||': 98,
    'A << B & K0|iii|0||': 99,
    'A << min(B & K0, K1) & K0|iii|0||': 100,
    'A << min(B & K0, K1) & K2|iii|0||': 101,
    'A <= B|ffb|0||': 102,
    'A <= B|iib|0||': 103,
    'A == -K0|ib|0||': 104,
    'A == 0 or A == 1|ib|0||': 105,
    'A == 0 or A == 2|ib|0||': 106,
    'A == 0|ib|0||': 107,
    'A == 1 or A == 2|ib|0||': 108,
    'A == 1|ib|0||': 109,
    'A == 2|ib|0||': 110,
    'A == B|bbb|0||': 111,
    'A == B|ffb|0||': 112,
    'A == B|iib|0||': 113,
    'A == K0|ib|0||': 114,
    'A > B|ffb|0||': 115,
    'A > B|iib|0||': 116,
    'A > K0|ib|0||': 117,
    'A >= B|ffb|0||': 118,
    'A >= B|iib|0||': 119,
    'A >> 0 & 1 == 1|ib|0||': 120,
    'A >> 1 & 1 == 1|ib|0||': 121,
    'A >> 1 | B >> 1 << K0|iii|0||': 122,
    'A >> B|iii|0||': 123,
    'A >> K0 & 1 == 1|ib|0||': 124,
    'A >> K0 & K1|ii|0||': 125,
    'A >> K0 << 1|ii|0||': 126,
    'A >> K0 | (A & K1) << K0|ii|0||': 127,
    'A >> K0 | A >> K1 & K2 | (A & K2) << K1 | (A & K3) << K0|ii|0||': 128,
    'A >> min(B & K0, K1)|iii|0||': 129,
    'A ^ B|bbb|0||': 130,
    'A ^ B|iii|0||': 131,
    'A ^ K0|ii|0||': 132,
    'A if A <= B else B|fff|0||': 133,
    'A if A <= B else B|iii|0||': 134,
    'A if A >= B else B|fff|0||': 135,
    'A if A >= B else B|iii|0||': 136,
    'A if B < A else C if B > C else B|ffff|0||': 137,
    'A if B < A else C if B > C else B|iiii|0||': 138,
    'A | B|bbb|0||': 139,
    'A | B|iii|0||': 140,
    'A|ii|0|not -K0 <= R <= K1|narrow(E, R, -K0, K2, site)': 141,
    'A|ii|0|not -K0 <= R <= K1|noted(E, R, KIND0, site)': 142,
    'A|ii|0|not 0 <= R <= K0|narrow(E, R, 0, K1, site)': 143,
    'A|ii|0||': 144,
    'B - B != 0.0 or B == 0.0 != A|ffb|0||': 145,
    'B - B != 0.0 or B == 0.0 != G0|ffb|0||': 146,
    'B - B != 0.0|ffb|0||': 147,
    'B == 0 or A == -K0 and B == -1|iib|0||': 148,
    'B if -K0 <= B <= K1 else A|iii|0||': 149,
    'B if 0 <= B <= K0 else A|iii|0||': 150,
    'B if A == 0 else False|ibb|0||': 151,
    'B if B - B == 0.0 else A|fff|0||': 152,
    'B if C and -K0 <= B <= K1 else A|iiii|0||': 153,
    'B if C and 0 <= B <= K0 else A|iiii|0||': 154,
    'B if C and B - B == 0.0 else A|ffff|0||': 155,
    'C - C != 0.0 or C == 0.0 != A * B|fffb|0||': 156,
    'C - C != 0.0 or C == 0.0 != A + B|fffb|0||': 157,
    'C - C != 0.0 or C == 0.0 != A - B|fffb|0||': 158,
    'C - C != 0.0 or C == 0.0 != A|fffb|0||': 159,
    'C if A else B|bbbb|0||': 160,
    'C if A else B|bfff|0||': 161,
    'C if A else B|biii|0||': 162,
    'K0 if not B else 0 if abs(A) < abs(B) else 2 if (A < 0) == (B < 0) else 1|iii|0||': 163,
    'K0 if not B else 2 if C > 0 else 1 if C < 0 else 0|iiii|0||': 164,
    'abs(A) > K0|ib|0||': 165,
    'abs(A)|ff|0||': 166,
    'abs(A)|ii|0|not -K0 <= R <= K1|wrap(E, R, -K0, K2, site)': 167,
    'approximate_acos(F[FACTOR], A)|ff|1|R and not G0 <= R * R <= G1|special(E, R, site)': 168,
    'approximate_asin(F[FACTOR], A)|ff|1|R and not G0 <= R * R <= G1|special(E, R, site)': 169,
    'approximate_atan(F[FACTOR], A)|ff|1|R and not G0 <= R * R <= G1|special(E, R, site)': 170,
    'approximate_cos(F[FACTOR], A)|ff|1|R and not G0 <= R * R <= G1|special(E, R, site)': 171,
    'approximate_exp(F[FACTOR], A)|ff|1|R and not G0 <= R * R <= G1|special(E, R, site)': 172,
    'approximate_ln(F[FACTOR], A)|ff|1|R and not G0 <= R * R <= G1|special(E, R, site)': 173,
    'approximate_log(F[FACTOR], A)|ff|1|R and not G0 <= R * R <= G1|special(E, R, site)': 174,
    'approximate_sin(F[FACTOR], A)|ff|1|R and not G0 <= R * R <= G1|special(E, R, site)': 175,
    'approximate_tan(F[FACTOR], A)|ff|1|R and not G0 <= R * R <= G1|special(E, R, site)': 176,
    'bits_to_real(A)|if|0||': 177,
    'count(T, A)|ib|0||': 178,
    'not -G0 <= A < G0|fb|0||': 179,
    'not -K0 <= A * B <= K1|iib|0||': 180,
    'not -K0 <= A + B <= K1|iib|0||': 181,
    'not -K0 <= A - B <= K1|iib|0||': 182,
    'not A|bb|0||': 183,
    'quotient(E, A, B, site)|iii|0|not -K0 <= R <= K1|noted(E, R, KIND0, site)': 184,
    'quotient(E, A, B, site)|iii|0|not -K0 <= R <= K1|wrap(E, R, -K0, K2, site)': 185,
    'quotient(E, A, B, site)|iii|0|not 0 <= R <= K0|noted(E, R, KIND0, site)': 186,
    'real_to_bits(A)|fi|0||': 187,
    'remainder(E, A, B, site) << K0 | quotient(E, A, B, site) & K1 if B else 0|iii|0||': 188,
    'remainder(E, A, B, site)|iii|0||': 189,
    'square_root(A)|ff|1|R and not G0 <= R * R <= G1|special(E, R, site)': 190,
    'to_integer(E, ROUNDING0, A, -K0, K1, site)|fi|0||': 191,
    'to_integer(E, ROUNDING1, A, -K0, K1, site)|fi|0||': 192,
    'to_integer(E, ROUNDING2, A, -K0, K1, site)|fi|0||': 193,
    'to_integer(E, ROUNDING3, A, -K0, K1, site)|fi|0||': 194,
    'truncated(A) if -G0 < A < G1 else K2|fi|0|not -K2 <= R <= K4|noted(E, R, KIND0, site)': 195,
    'whole(A + (G0 if A > 0.0 else -G0)) if -G1 < A < G2 else K3|fi|0|not -K3 <= R <= K5|noted(E, R, KIND0, site)': 196,
    'whole(A)|bi|0||': 197,
}


@njit(cache=True, error_model="numpy", nogil=True)
def run(code: Any, room: Any, M: Any) -> int:
    I = room[SLOTS:]
    F = I.view(np.float64)
    pc = room[START]
    while True:
        op = code[pc, 0]
        t, a, b, c, d = code[pc, 1], code[pc, 2], code[pc, 3], code[pc, 4], code[pc, 5]
        site = code[pc, 12]
        if op == 0:
            if room[EVENTS] > MOST_EVENTS:
                room[START] = pc - 1
                return FULL
            room[BUDGET] -= 1
            if room[BUDGET] < 0:
                room[START] = pc
                return EXHAUSTED
            pc = t - 1
        elif op == 1:
            pc = t - 1
        elif op == 2:
            if I[a] != 0:
                pc = t - 1
        elif op == 3:
            if I[a] == 0:
                pc = t - 1
        elif op == 4:
            if room[EVENTS] > MOST_EVENTS:
                room[START] = pc - 1
                return FULL
            room[BUDGET] -= 1
            if room[BUDGET] < 0:
                room[START] = pc
                return EXHAUSTED
            room[STACK + room[CALLS]] = pc
            room[STACK + room[CALLS] + 1] = I[1]
            room[CALLS] += 2
            I[1] = I[a] + b
            pc = t - 1
        elif op == 5:
            if room[CALLS] == 0:
                return DONE
            room[CALLS] -= 2
            pc = room[STACK + room[CALLS]]
            I[1] = room[STACK + room[CALLS] + 1]
        elif op == 6:
            room[START] = pc
            return REQUEST
        elif op == 7:
            I[t] = I[a]
        elif op == 8:
            for place in range(b):
                M[t + place] = I[c] & 255
        elif op == 9:
            p, bit = t + I[a] + (I[b] >> 3), c + I[d] + (I[code[pc, 7]] >> 3)
            for place in range(code[pc, 6]):
                M[p + place] = M[bit + place]
        elif op == 10:
            bit = a + (I[b] << 3) + I[c]
            I[t] = (M[bit >> 3] >> (bit & 7)) & 1
        elif op == 11:
            I[t] = M[a + I[b] + (I[c] >> 3)]
        elif op == 12:
            x = M[a + I[b] + (I[c] >> 3)]
            I[t] = np.int64(x) - 256 if x > 127 else np.int64(x)
        elif op == 13:
            p = a + I[b] + (I[c] >> 3)
            I[t] = np.int64(M[p]) << 8 | np.int64(M[p + 1])
        elif op == 14:
            p = a + I[b] + (I[c] >> 3)
            x = np.int64(M[p]) << 8 | np.int64(M[p + 1])
            I[t] = x - 65536 if x > 32767 else x
        elif op == 15:
            p = a + I[b] + (I[c] >> 3)
            I[t] = np.int64(M[p]) << 24 | np.int64(M[p + 1]) << 16 | np.int64(M[p + 2]) << 8 | np.int64(M[p + 3])
        elif op == 16:
            p = a + I[b] + (I[c] >> 3)
            x = np.int64(M[p]) << 24 | np.int64(M[p + 1]) << 16 | np.int64(M[p + 2]) << 8 | np.int64(M[p + 3])
            I[t] = x - 4294967296 if x > 2147483647 else x
        elif op == 17:
            p = a + I[b] + (I[c] >> 3)
            F[t] = bits_to_real(np.int64(M[p]) << 24 | np.int64(M[p + 1]) << 16 | np.int64(M[p + 2]) << 8 | np.int64(M[p + 3]))
        elif op == 18:
            p = a + I[b] + (I[c] >> 3)
            x = np.int64(M[p])
            for place in range(1, 8):
                x = x << 8 | np.int64(M[p + place])
            I[t] = x
        elif op == 19:
            bit = t + (I[b] << 3) + I[c]
            if I[d] != 0:
                M[bit >> 3] |= 1 << (bit & 7)
            else:
                M[bit >> 3] &= 255 - (1 << (bit & 7))
        elif op == 20:
            M[t + I[b] + (I[c] >> 3)] = I[d] & 255
        elif op == 21:
            p = t + I[b] + (I[c] >> 3)
            x = I[d]
            M[p] = x >> 8 & 255
            M[p + 1] = x & 255
        elif op == 22:
            p = t + I[b] + (I[c] >> 3)
            x = I[d]
            M[p] = x >> 24 & 255
            M[p + 1] = x >> 16 & 255
            M[p + 2] = x >> 8 & 255
            M[p + 3] = x & 255
        elif op == 23:
            p = t + I[b] + (I[c] >> 3)
            x = real_to_bits(F[d])
            M[p] = x >> 24 & 255
            M[p + 1] = x >> 16 & 255
            M[p + 2] = x >> 8 & 255
            M[p + 3] = x & 255
        elif op == 24:
            p = t + I[b] + (I[c] >> 3)
            x = I[d]
            for place in range(8):
                M[p + 7 - place] = x & 255
                x = x >> 8
        elif op == 25:
            if I[a] < I[b] or I[a] > I[c]:
                room[START] = pc
                return REQUEST
            I[t] = (I[a] - I[b]) * I[d]
        elif op == 26:
            for place in range(b):
                I[t + place] = I[a + place]
        elif op == 32:
            R = ((I[a] & I[code[pc, 6]]) << I[code[pc, 7]]) + 0 if I[a] >> I[code[pc, 8]] == I[code[pc, 9]] and (I[a] & I[code[pc, 6]]) <= I[code[pc, 10]] else -1 - I[a]
            if R < 0:
                room[START] = pc
                return REQUEST
            I[t] = R
        elif op == 33:
            I[t] = ((I[a] + I[b]) & I[code[pc, 6]] ^ I[code[pc, 7]]) - I[code[pc, 7]]
        elif op == 34:
            I[t] = (I[a] & 1) << 1
        elif op == 35:
            I[t] = (I[a] & I[code[pc, 6]] ^ I[code[pc, 7]]) - I[code[pc, 7]]
        elif op == 36:
            R = (I[a] & I[code[pc, 6]]) + 0
            if R > I[code[pc, 7]] or R & I[code[pc, 8]]:
                room[START] = pc
                return REQUEST
            I[t] = R
        elif op == 37:
            R = (I[a] & I[code[pc, 6]]) + 0
            if R > I[code[pc, 7]]:
                room[START] = pc
                return REQUEST
            I[t] = R
        elif op == 38:
            R = (I[a] & I[code[pc, 6]]) + I[code[pc, 7]]
            if R > I[code[pc, 8]] or R & I[code[pc, 9]]:
                room[START] = pc
                return REQUEST
            I[t] = R
        elif op == 39:
            R = (I[a] & I[code[pc, 6]]) + I[code[pc, 7]]
            if R > I[code[pc, 8]]:
                room[START] = pc
                return REQUEST
            I[t] = R
        elif op == 40:
            I[t] = (I[a] << (I[b] % I[code[pc, 6]]) | I[a] >> I[code[pc, 6]] - (I[b] % I[code[pc, 6]])) & I[code[pc, 7]]
        elif op == 41:
            I[t] = (I[a] << 1 | I[b] >> 1) & I[code[pc, 6]]
        elif op == 42:
            I[t] = (I[a] << I[b] % I[code[pc, 6]] | I[a] >> I[code[pc, 6]] - I[b] % I[code[pc, 6]]) & I[code[pc, 7]]
        elif op == 43:
            I[t] = (I[a] << I[b] >> I[code[pc, 6]] & 1) << 1 if I[b] else I[c]
        elif op == 44:
            I[t] = (I[a] >> (I[b] % I[code[pc, 6]]) | I[a] << I[code[pc, 6]] - (I[b] % I[code[pc, 6]])) & I[code[pc, 7]]
        elif op == 45:
            I[t] = (I[a] >> (I[b] - 1) % I[code[pc, 6]] & 1) << 1 if I[b] else I[c]
        elif op == 46:
            I[t] = (I[a] >> (I[code[pc, 6]] - I[b]) % I[code[pc, 6]] & 1) << 1 if I[b] else I[c]
        elif op == 47:
            I[t] = (I[a] >> I[b] % I[code[pc, 6]] | I[a] << I[code[pc, 6]] - I[b] % I[code[pc, 6]]) & I[code[pc, 7]]
        elif op == 48:
            I[t] = (I[a] >> I[b] - 1 & 1) << 1 if I[b] else I[c]
        elif op == 49:
            I[t] = (remainder(room[EVENTS:SLOTS], I[a], I[b], site) & I[code[pc, 6]]) << I[code[pc, 7]] | quotient(room[EVENTS:SLOTS], I[a], I[b], site) & I[code[pc, 6]] if I[b] else noted(room[EVENTS:SLOTS], I[c], KIND2, site)
        elif op == 50:
            F[t] = -F[a]
        elif op == 51:
            R = -I[a]
            if not -I[code[pc, 6]] <= R <= I[code[pc, 7]]:
                R = wrap(room[EVENTS:SLOTS], R, -I[code[pc, 6]], I[code[pc, 8]], site)
            I[t] = R
        elif op == 52:
            I[t] = 0 if not I[a] or not I[b] else 2 if (I[a] < 0) == (I[b] < 0) else 1
        elif op == 53:
            I[t] = 2 if I[a] > 0 else 1 if I[a] < 0 else 0
        elif op == 54:
            I[t] = 2 if F[a] > 0.0 else 1 if F[a] < 0.0 else 0 if F[a] == 0.0 else I[code[pc, 6]]
        elif op == 55:
            I[t] = 2 if F[a] > F[b] else 1 if F[a] < F[b] else 0 if F[a] == F[b] else I[code[pc, 6]]
        elif op == 56:
            I[t] = 2 if I[a] > I[b] else 1 if I[a] < I[b] else 0
        elif op == 57:
            I[t] = 2 if I[a] else 0
        elif op == 58:
            I[t] = 1 if (F[a] != F[a] or F[b] != F[b]) else 0
        elif op == 59:
            I[t] = 1 if (I[a] != I[b]) else 0
        elif op == 60:
            I[t] = 1 if (I[a] != I[b]) else 0
        elif op == 61:
            I[t] = 1 if (I[a] & 1 == 1) else 0
        elif op == 62:
            I[t] = 1 if (I[a] & I[b]) else 0
        elif op == 63:
            I[t] = I[a] & I[b]
        elif op == 64:
            I[t] = I[a] & I[code[pc, 6]] | (0 if -I[code[pc, 7]] <= I[b] <= I[code[pc, 8]] else 2)
        elif op == 65:
            I[t] = I[a] & I[code[pc, 6]] | (0 if 0 <= I[b] <= I[code[pc, 7]] else 2)
        elif op == 66:
            I[t] = I[a] & I[code[pc, 6]] | (1 if I[b] == 0 else 0)
        elif op == 67:
            I[t] = I[a] & I[code[pc, 6]] | (2 if not -I[code[pc, 7]] <= I[b] <= I[code[pc, 8]] else 1 if I[b] == 0 else I[code[pc, 9]] if I[b] < 0 else 0) if I[c] else I[a] | I[code[pc, 10]]
        elif op == 68:
            I[t] = I[a] & I[code[pc, 6]] | (2 if not -I[code[pc, 7]] <= I[b] <= I[code[pc, 8]] else 1 if I[b] == 0 else I[code[pc, 9]] if I[b] < 0 else 0)
        elif op == 69:
            I[t] = I[a] & I[code[pc, 6]] | (2 if not 0 <= I[b] <= I[code[pc, 7]] else 1 if I[b] == 0 else I[code[pc, 8]] if I[b] < 0 else 0) if I[c] else I[a] | I[code[pc, 9]]
        elif op == 70:
            I[t] = I[a] & I[code[pc, 6]] | (2 if not 0 <= I[b] <= I[code[pc, 7]] else 1 if I[b] == 0 else I[code[pc, 8]] if I[b] < 0 else 0)
        elif op == 71:
            I[t] = I[a] & I[code[pc, 6]] | (2 if not F[b] - F[b] == 0.0 else 1 if F[b] == 0 else I[code[pc, 7]] if F[b] < 0 else 0) if F[c] else I[a] | I[code[pc, 8]]
        elif op == 72:
            I[t] = I[a] & I[code[pc, 6]] | (2 if not F[b] - F[b] == 0.0 else 1 if F[b] == 0 else I[code[pc, 7]] if F[b] < 0 else 0)
        elif op == 73:
            I[t] = I[a] & I[code[pc, 6]] | I[a] + I[b] & I[code[pc, 7]]
        elif op == 74:
            I[t] = I[a] & I[code[pc, 6]] | I[b] & I[code[pc, 7]]
        elif op == 75:
            I[t] = I[a] & I[code[pc, 6]] | I[b]
        elif op == 76:
            I[t] = I[a] & I[code[pc, 6]]
        elif op == 77:
            Q = np.float64(np.float32(F[a] * F[a]))
            if Q and not F[code[pc, 6]] <= Q * Q <= F[code[pc, 7]]:
                Q = special(room[EVENTS:SLOTS], Q, site)
            F[t] = Q
        elif op == 78:
            Q = np.float64(np.float32(F[a] * F[b]))
            if Q and not F[code[pc, 6]] <= Q * Q <= F[code[pc, 7]]:
                Q = special(room[EVENTS:SLOTS], Q, site)
            F[t] = Q
        elif op == 79:
            R = I[a] * I[b]
            if not -I[code[pc, 6]] <= R <= I[code[pc, 7]]:
                R = noted(room[EVENTS:SLOTS], R, KIND0, site)
            I[t] = R
        elif op == 80:
            R = I[a] * I[b]
            if not -I[code[pc, 6]] <= R <= I[code[pc, 7]]:
                R = wrap(room[EVENTS:SLOTS], R, -I[code[pc, 6]], I[code[pc, 8]], site)
            I[t] = R
        elif op == 81:
            R = I[a] * I[b]
            if not 0 <= R <= I[code[pc, 6]]:
                R = noted(room[EVENTS:SLOTS], R, KIND0, site)
            I[t] = R
        elif op == 82:
            I[t] = I[a] * I[b]
        elif op == 83:
            F[t] = I[a] + 0.0
        elif op == 84:
            F[t] = np.float64(np.float32(I[a] + 0.0))
        elif op == 85:
            I[t] = I[a] + I[b] & I[code[pc, 6]]
        elif op == 86:
            Q = np.float64(np.float32(F[a] + F[b]))
            if Q and not F[code[pc, 6]] <= Q * Q <= F[code[pc, 7]]:
                Q = special(room[EVENTS:SLOTS], Q, site)
            F[t] = Q
        elif op == 87:
            R = I[a] + I[b]
            if not -I[code[pc, 6]] <= R <= I[code[pc, 7]]:
                R = noted(room[EVENTS:SLOTS], R, KIND0, site)
            I[t] = R
        elif op == 88:
            R = I[a] + I[b]
            if not -I[code[pc, 6]] <= R <= I[code[pc, 7]]:
                R = wrap(room[EVENTS:SLOTS], R, -I[code[pc, 6]], I[code[pc, 8]], site)
            I[t] = R
        elif op == 89:
            R = I[a] + I[b]
            if not 0 <= R <= I[code[pc, 6]]:
                R = noted(room[EVENTS:SLOTS], R, KIND0, site)
            I[t] = R
        elif op == 90:
            I[t] = I[a] - I[b] & I[code[pc, 6]]
        elif op == 91:
            Q = np.float64(np.float32(F[a] - F[b]))
            if Q and not F[code[pc, 6]] <= Q * Q <= F[code[pc, 7]]:
                Q = special(room[EVENTS:SLOTS], Q, site)
            F[t] = Q
        elif op == 92:
            R = I[a] - I[b]
            if not -I[code[pc, 6]] <= R <= I[code[pc, 7]]:
                R = noted(room[EVENTS:SLOTS], R, KIND0, site)
            I[t] = R
        elif op == 93:
            R = I[a] - I[b]
            if not -I[code[pc, 6]] <= R <= I[code[pc, 7]]:
                R = wrap(room[EVENTS:SLOTS], R, -I[code[pc, 6]], I[code[pc, 8]], site)
            I[t] = R
        elif op == 94:
            R = I[a] - I[b]
            if not 0 <= R <= I[code[pc, 6]]:
                R = noted(room[EVENTS:SLOTS], R, KIND0, site)
            I[t] = R
        elif op == 95:
            Q = np.float64(np.float32(F[a] / F[b] if F[b] else over_zero(room[EVENTS:SLOTS], F[a], F[b])))
            if Q and not F[code[pc, 6]] <= Q * Q <= F[code[pc, 7]]:
                Q = special(room[EVENTS:SLOTS], Q, site)
            F[t] = Q
        elif op == 96:
            I[t] = 1 if (F[a] < F[b] or F[a] > F[b]) else 0
        elif op == 97:
            I[t] = 1 if (F[a] < F[b]) else 0
        elif op == 98:
            I[t] = 1 if (I[a] < I[b]) else 0
        elif op == 99:
            I[t] = I[a] << I[b] & I[code[pc, 6]]
        elif op == 100:
            I[t] = I[a] << min(I[b] & I[code[pc, 6]], I[code[pc, 7]]) & I[code[pc, 6]]
        elif op == 101:
            I[t] = I[a] << min(I[b] & I[code[pc, 6]], I[code[pc, 7]]) & I[code[pc, 8]]
        elif op == 102:
            I[t] = 1 if (F[a] <= F[b]) else 0
        elif op == 103:
            I[t] = 1 if (I[a] <= I[b]) else 0
        elif op == 104:
            I[t] = 1 if (I[a] == -I[code[pc, 6]]) else 0
        elif op == 105:
            I[t] = 1 if (I[a] == 0 or I[a] == 1) else 0
        elif op == 106:
            I[t] = 1 if (I[a] == 0 or I[a] == 2) else 0
        elif op == 107:
            I[t] = 1 if (I[a] == 0) else 0
        elif op == 108:
            I[t] = 1 if (I[a] == 1 or I[a] == 2) else 0
        elif op == 109:
            I[t] = 1 if (I[a] == 1) else 0
        elif op == 110:
            I[t] = 1 if (I[a] == 2) else 0
        elif op == 111:
            I[t] = 1 if (I[a] == I[b]) else 0
        elif op == 112:
            I[t] = 1 if (F[a] == F[b]) else 0
        elif op == 113:
            I[t] = 1 if (I[a] == I[b]) else 0
        elif op == 114:
            I[t] = 1 if (I[a] == I[code[pc, 6]]) else 0
        elif op == 115:
            I[t] = 1 if (F[a] > F[b]) else 0
        elif op == 116:
            I[t] = 1 if (I[a] > I[b]) else 0
        elif op == 117:
            I[t] = 1 if (I[a] > I[code[pc, 6]]) else 0
        elif op == 118:
            I[t] = 1 if (F[a] >= F[b]) else 0
        elif op == 119:
            I[t] = 1 if (I[a] >= I[b]) else 0
        elif op == 120:
            I[t] = 1 if (I[a] >> 0 & 1 == 1) else 0
        elif op == 121:
            I[t] = 1 if (I[a] >> 1 & 1 == 1) else 0
        elif op == 122:
            I[t] = I[a] >> 1 | I[b] >> 1 << I[code[pc, 6]]
        elif op == 123:
            I[t] = I[a] >> I[b]
        elif op == 124:
            I[t] = 1 if (I[a] >> I[code[pc, 6]] & 1 == 1) else 0
        elif op == 125:
            I[t] = I[a] >> I[code[pc, 6]] & I[code[pc, 7]]
        elif op == 126:
            I[t] = I[a] >> I[code[pc, 6]] << 1
        elif op == 127:
            I[t] = I[a] >> I[code[pc, 6]] | (I[a] & I[code[pc, 7]]) << I[code[pc, 6]]
        elif op == 128:
            I[t] = I[a] >> I[code[pc, 6]] | I[a] >> I[code[pc, 7]] & I[code[pc, 8]] | (I[a] & I[code[pc, 8]]) << I[code[pc, 7]] | (I[a] & I[code[pc, 9]]) << I[code[pc, 6]]
        elif op == 129:
            I[t] = I[a] >> min(I[b] & I[code[pc, 6]], I[code[pc, 7]])
        elif op == 130:
            I[t] = 1 if (I[a] ^ I[b]) else 0
        elif op == 131:
            I[t] = I[a] ^ I[b]
        elif op == 132:
            I[t] = I[a] ^ I[code[pc, 6]]
        elif op == 133:
            F[t] = F[a] if F[a] <= F[b] else F[b]
        elif op == 134:
            I[t] = I[a] if I[a] <= I[b] else I[b]
        elif op == 135:
            F[t] = F[a] if F[a] >= F[b] else F[b]
        elif op == 136:
            I[t] = I[a] if I[a] >= I[b] else I[b]
        elif op == 137:
            F[t] = F[a] if F[b] < F[a] else F[c] if F[b] > F[c] else F[b]
        elif op == 138:
            I[t] = I[a] if I[b] < I[a] else I[c] if I[b] > I[c] else I[b]
        elif op == 139:
            I[t] = 1 if (I[a] | I[b]) else 0
        elif op == 140:
            I[t] = I[a] | I[b]
        elif op == 141:
            R = I[a]
            if not -I[code[pc, 6]] <= R <= I[code[pc, 7]]:
                R = narrow(room[EVENTS:SLOTS], R, -I[code[pc, 6]], I[code[pc, 8]], site)
            I[t] = R
        elif op == 142:
            R = I[a]
            if not -I[code[pc, 6]] <= R <= I[code[pc, 7]]:
                R = noted(room[EVENTS:SLOTS], R, KIND0, site)
            I[t] = R
        elif op == 143:
            R = I[a]
            if not 0 <= R <= I[code[pc, 6]]:
                R = narrow(room[EVENTS:SLOTS], R, 0, I[code[pc, 7]], site)
            I[t] = R
        elif op == 144:
            I[t] = I[a]
        elif op == 145:
            I[t] = 1 if (F[b] - F[b] != 0.0 or F[b] == 0.0 != F[a]) else 0
        elif op == 146:
            I[t] = 1 if (F[b] - F[b] != 0.0 or F[b] == 0.0 != F[code[pc, 6]]) else 0
        elif op == 147:
            I[t] = 1 if (F[b] - F[b] != 0.0) else 0
        elif op == 148:
            I[t] = 1 if (I[b] == 0 or I[a] == -I[code[pc, 6]] and I[b] == -1) else 0
        elif op == 149:
            I[t] = I[b] if -I[code[pc, 6]] <= I[b] <= I[code[pc, 7]] else I[a]
        elif op == 150:
            I[t] = I[b] if 0 <= I[b] <= I[code[pc, 6]] else I[a]
        elif op == 151:
            I[t] = 1 if (I[b] if I[a] == 0 else False) else 0
        elif op == 152:
            F[t] = F[b] if F[b] - F[b] == 0.0 else F[a]
        elif op == 153:
            I[t] = I[b] if I[c] and -I[code[pc, 6]] <= I[b] <= I[code[pc, 7]] else I[a]
        elif op == 154:
            I[t] = I[b] if I[c] and 0 <= I[b] <= I[code[pc, 6]] else I[a]
        elif op == 155:
            F[t] = F[b] if F[c] and F[b] - F[b] == 0.0 else F[a]
        elif op == 156:
            I[t] = 1 if (F[c] - F[c] != 0.0 or F[c] == 0.0 != F[a] * F[b]) else 0
        elif op == 157:
            I[t] = 1 if (F[c] - F[c] != 0.0 or F[c] == 0.0 != F[a] + F[b]) else 0
        elif op == 158:
            I[t] = 1 if (F[c] - F[c] != 0.0 or F[c] == 0.0 != F[a] - F[b]) else 0
        elif op == 159:
            I[t] = 1 if (F[c] - F[c] != 0.0 or F[c] == 0.0 != F[a]) else 0
        elif op == 160:
            I[t] = 1 if (I[c] if I[a] else I[b]) else 0
        elif op == 161:
            F[t] = F[c] if I[a] else F[b]
        elif op == 162:
            I[t] = I[c] if I[a] else I[b]
        elif op == 163:
            I[t] = I[code[pc, 6]] if not I[b] else 0 if abs(I[a]) < abs(I[b]) else 2 if (I[a] < 0) == (I[b] < 0) else 1
        elif op == 164:
            I[t] = I[code[pc, 6]] if not I[b] else 2 if I[c] > 0 else 1 if I[c] < 0 else 0
        elif op == 165:
            I[t] = 1 if (abs(I[a]) > I[code[pc, 6]]) else 0
        elif op == 166:
            F[t] = abs(F[a])
        elif op == 167:
            R = abs(I[a])
            if not -I[code[pc, 6]] <= R <= I[code[pc, 7]]:
                R = wrap(room[EVENTS:SLOTS], R, -I[code[pc, 6]], I[code[pc, 8]], site)
            I[t] = R
        elif op == 168:
            Q = np.float64(np.float32(approximate_acos(F[FACTOR], F[a])))
            if Q and not F[code[pc, 6]] <= Q * Q <= F[code[pc, 7]]:
                Q = special(room[EVENTS:SLOTS], Q, site)
            F[t] = Q
        elif op == 169:
            Q = np.float64(np.float32(approximate_asin(F[FACTOR], F[a])))
            if Q and not F[code[pc, 6]] <= Q * Q <= F[code[pc, 7]]:
                Q = special(room[EVENTS:SLOTS], Q, site)
            F[t] = Q
        elif op == 170:
            Q = np.float64(np.float32(approximate_atan(F[FACTOR], F[a])))
            if Q and not F[code[pc, 6]] <= Q * Q <= F[code[pc, 7]]:
                Q = special(room[EVENTS:SLOTS], Q, site)
            F[t] = Q
        elif op == 171:
            Q = np.float64(np.float32(approximate_cos(F[FACTOR], F[a])))
            if Q and not F[code[pc, 6]] <= Q * Q <= F[code[pc, 7]]:
                Q = special(room[EVENTS:SLOTS], Q, site)
            F[t] = Q
        elif op == 172:
            Q = np.float64(np.float32(approximate_exp(F[FACTOR], F[a])))
            if Q and not F[code[pc, 6]] <= Q * Q <= F[code[pc, 7]]:
                Q = special(room[EVENTS:SLOTS], Q, site)
            F[t] = Q
        elif op == 173:
            Q = np.float64(np.float32(approximate_ln(F[FACTOR], F[a])))
            if Q and not F[code[pc, 6]] <= Q * Q <= F[code[pc, 7]]:
                Q = special(room[EVENTS:SLOTS], Q, site)
            F[t] = Q
        elif op == 174:
            Q = np.float64(np.float32(approximate_log(F[FACTOR], F[a])))
            if Q and not F[code[pc, 6]] <= Q * Q <= F[code[pc, 7]]:
                Q = special(room[EVENTS:SLOTS], Q, site)
            F[t] = Q
        elif op == 175:
            Q = np.float64(np.float32(approximate_sin(F[FACTOR], F[a])))
            if Q and not F[code[pc, 6]] <= Q * Q <= F[code[pc, 7]]:
                Q = special(room[EVENTS:SLOTS], Q, site)
            F[t] = Q
        elif op == 176:
            Q = np.float64(np.float32(approximate_tan(F[FACTOR], F[a])))
            if Q and not F[code[pc, 6]] <= Q * Q <= F[code[pc, 7]]:
                Q = special(room[EVENTS:SLOTS], Q, site)
            F[t] = Q
        elif op == 177:
            F[t] = bits_to_real(I[a])
        elif op == 178:
            I[t] = 1 if (count(room[COUNTS:STACK], I[a])) else 0
        elif op == 179:
            I[t] = 1 if (not -F[code[pc, 6]] <= F[a] < F[code[pc, 6]]) else 0
        elif op == 180:
            I[t] = 1 if (not -I[code[pc, 6]] <= I[a] * I[b] <= I[code[pc, 7]]) else 0
        elif op == 181:
            I[t] = 1 if (not -I[code[pc, 6]] <= I[a] + I[b] <= I[code[pc, 7]]) else 0
        elif op == 182:
            I[t] = 1 if (not -I[code[pc, 6]] <= I[a] - I[b] <= I[code[pc, 7]]) else 0
        elif op == 183:
            I[t] = 1 if (not I[a]) else 0
        elif op == 184:
            R = quotient(room[EVENTS:SLOTS], I[a], I[b], site)
            if not -I[code[pc, 6]] <= R <= I[code[pc, 7]]:
                R = noted(room[EVENTS:SLOTS], R, KIND0, site)
            I[t] = R
        elif op == 185:
            R = quotient(room[EVENTS:SLOTS], I[a], I[b], site)
            if not -I[code[pc, 6]] <= R <= I[code[pc, 7]]:
                R = wrap(room[EVENTS:SLOTS], R, -I[code[pc, 6]], I[code[pc, 8]], site)
            I[t] = R
        elif op == 186:
            R = quotient(room[EVENTS:SLOTS], I[a], I[b], site)
            if not 0 <= R <= I[code[pc, 6]]:
                R = noted(room[EVENTS:SLOTS], R, KIND0, site)
            I[t] = R
        elif op == 187:
            I[t] = real_to_bits(F[a])
        elif op == 188:
            I[t] = remainder(room[EVENTS:SLOTS], I[a], I[b], site) << I[code[pc, 6]] | quotient(room[EVENTS:SLOTS], I[a], I[b], site) & I[code[pc, 7]] if I[b] else 0
        elif op == 189:
            I[t] = remainder(room[EVENTS:SLOTS], I[a], I[b], site)
        elif op == 190:
            Q = np.float64(np.float32(square_root(F[a])))
            if Q and not F[code[pc, 6]] <= Q * Q <= F[code[pc, 7]]:
                Q = special(room[EVENTS:SLOTS], Q, site)
            F[t] = Q
        elif op == 191:
            I[t] = to_integer(room[EVENTS:SLOTS], ROUNDING0, F[a], -I[code[pc, 6]], I[code[pc, 7]], site)
        elif op == 192:
            I[t] = to_integer(room[EVENTS:SLOTS], ROUNDING1, F[a], -I[code[pc, 6]], I[code[pc, 7]], site)
        elif op == 193:
            I[t] = to_integer(room[EVENTS:SLOTS], ROUNDING2, F[a], -I[code[pc, 6]], I[code[pc, 7]], site)
        elif op == 194:
            I[t] = to_integer(room[EVENTS:SLOTS], ROUNDING3, F[a], -I[code[pc, 6]], I[code[pc, 7]], site)
        elif op == 195:
            R = truncated(F[a]) if -F[code[pc, 6]] < F[a] < F[code[pc, 7]] else I[code[pc, 8]]
            if not -I[code[pc, 8]] <= R <= I[code[pc, 10]]:
                R = noted(room[EVENTS:SLOTS], R, KIND0, site)
            I[t] = R
        elif op == 196:
            R = whole(F[a] + (F[code[pc, 6]] if F[a] > 0.0 else -F[code[pc, 6]])) if -F[code[pc, 7]] < F[a] < F[code[pc, 8]] else I[code[pc, 9]]
            if not -I[code[pc, 9]] <= R <= I[code[pc, 11]]:
                R = noted(room[EVENTS:SLOTS], R, KIND0, site)
            I[t] = R
        elif op == 197:
            I[t] = whole(I[a])
        pc += 1


@njit(cache=True, error_model="numpy", nogil=True)
def enter(code: Any, room: Any, memory: Any, start: int, base: int, budget: int) -> int:
    """Run from row `start` on the instance at `base`. Returns QUIET, or what `run` ended with."""
    room[START], room[BUDGET], room[CALLS] = start, budget, 0
    room[SLOTS + BASE] = base
    ended = HANDED_OVER
    if room[NATIVE]:
        ended = called(room[NATIVE], room.ctypes.data, memory.ctypes.data, start)
    if ended == HANDED_OVER:
        ended = run(code, room, memory)
    return QUIET if ended == DONE and not room[EVENTS] else ended
