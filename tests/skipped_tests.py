#!/usr/bin/env python3
"""Says what a run of ctest skipped, and why.

    skipped_tests.py BUILD/Testing/Temporary/LastTest.log

gtest's and unittest's skipped cases count inside tests that pass: ctest does not tell of them, and its log writes "Test
Passed." for a test that ended with 77. A script that skips as a whole ends its output with the word "skipped".
Always ends with 0: skipping is no failure.
"""
import collections
import re
import sys

START = re.compile(r"^\d+/\d+ Testing: (.+)$")
# "path:12: Skipped" is followed by the reason, then by "[  SKIPPED ] Suite.Case (0 ms)".
GTEST_CASE = re.compile(r"^\[  SKIPPED \] \S+ \(\d+ ms\)$")
GTEST_REASON = re.compile(r": Skipped$")
# "test_name (module.Class) ... skipped 'reason'"
UNITTEST_CASE = re.compile(r"""\bskipped ('.*'|".*")$""")


def tests_of(log):
    """(name, lines of its entry) of each test."""
    name, lines = None, []
    for line in log:
        line = line.rstrip("\n")
        start = START.match(line)
        if start:
            if name is not None:
                yield name, lines
            name, lines = start.group(1), []
        lines.append(line)
    if name is not None:
        yield name, lines


def output_of(lines):
    """What the test printed: between the line of dashes and "<end of output>"."""
    begin = next((i for i, line in enumerate(lines) if line.startswith("-----")), -1)
    end = next((i for i, line in enumerate(lines) if line == "<end of output>"), len(lines))
    return lines[begin + 1:end]


def skipped_cases(lines):
    """The reason of each skipped case of one test."""
    output, reasons, reason = output_of(lines), [], ""
    for i, line in enumerate(output):
        if GTEST_REASON.search(line):
            reason = output[i + 1].strip() if i + 1 < len(output) else ""
        elif GTEST_CASE.match(line):
            reasons.append(reason or "no reason given")
            reason = ""
        elif UNITTEST_CASE.search(line):
            reasons.append(UNITTEST_CASE.search(line).group(1)[1:-1])
    said = [line.strip() for line in output if line.strip()]
    if not reasons and said and said[-1].endswith("skipped"):
        reasons.append(said[-1])
    return reasons


def summary(log):
    """The lines to print."""
    skipped = {name: skipped_cases(lines) for name, lines in tests_of(log)}
    skipped = {name: reasons for name, reasons in skipped.items() if reasons}
    if not skipped:
        return ["tests: nothing was skipped"]
    cases = sum(map(len, skipped.values()))
    lines = [f"tests: SKIPPED {cases} case{'s' * (cases > 1)} of {len(skipped)} test{'s' * (len(skipped) > 1)}:"]
    for name, reasons in sorted(skipped.items()):
        for reason, count in collections.Counter(reasons).most_common():
            lines.append(f"  {name} ({count}): {reason}")
    return lines


def main():
    if len(sys.argv) != 2:
        raise SystemExit(__doc__)
    try:
        with open(sys.argv[1], encoding="utf-8", errors="replace") as log:
            print("\n".join(summary(log)))
    except FileNotFoundError:
        print("tests: no log of this run: what was skipped is not known")


if __name__ == "__main__":
    main()
