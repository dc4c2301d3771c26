#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Loops compiled for more instructions than the program share no code with it: the linker could take their copy of an
inline function for everybody, and the program would end with SIGILL on a processor that lacks them.

usage: instruction_sets.py ARCHIVE    (with the objects acoustic_kernel_v*.cpp.o; 77: there are none)
"""
import re
import subprocess
import sys


def main():
    listed = subprocess.run(["nm", "--demangle", sys.argv[1]], capture_output=True, text=True, check=True).stdout
    found, shared = 0, []
    for part in re.split(r"\n(?=\S+\.o:\n)", listed):
        name = re.match(r"\n*(acoustic_kernel_(v\d)\.cpp\.o):", part)
        if not name:
            continue
        found += 1
        for line in part.splitlines()[1:]:
            kind, _, symbol = line[17:].partition(" ")
            # Capital letters and u are seen by the linker; U is only used here; DW.ref is data of the compiler.
            seen = (kind.isupper() or kind == "u") and kind != "U" and "DW.ref" not in symbol
            if seen and f"::{name[2]}::" not in symbol:
                shared.append(f"{name[1]}: {kind} {symbol}")
    if not found:
        sys.exit(77)
    if shared:
        sys.exit("shared with code for other instructions:\n  " + "\n  ".join(shared))
    print(f"{found} builds of the loops, nothing shared")


if __name__ == "__main__":
    main()
