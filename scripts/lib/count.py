"""Counts test cases in a log and prints "PASSED FAILED".

usage: count.py gtest|unittest|vitest LOG STATUS   (STATUS: exit status of the run; a run that died counts as a failure)

gtest: the output of `ctest --verbose`; unittest: of `python3 -m unittest`; vitest: its JSON report.
"""
import json
import pathlib
import re
import sys


def count_gtest(text):
    passed = len(re.findall(r"^\d+: \[       OK \] ", text, re.M))
    cases = re.findall(r"^(\d+): \[  FAILED  \] \S+ \(\d+ ms\)$", text, re.M)
    failed = len(cases)
    # An executable that crashed or ran out of time names no failed case.
    for number in re.findall(r"^\t\s*(\d+) - ", text, re.M):
        if number not in cases:
            failed += 1
    return passed, failed


def count_unittest(text):
    ran = sum(int(n) for n in re.findall(r"^Ran (\d+) tests?", text, re.M))
    problems = sum(int(n) for n in re.findall(r"\b(?:failures|errors|unexpected successes)=(\d+)", text))
    skipped = sum(int(n) for n in re.findall(r"\bskipped=(\d+)", text))
    return max(ran - problems - skipped, 0), problems


def count_vitest(text):
    report = json.loads(text) if text else {}
    failed = report.get("numFailedTests", 0)
    # A file that could not be loaded has no cases.
    failed += sum(1 for file in report.get("testResults", []) if file["status"] == "failed" and not file["assertionResults"])
    return report.get("numPassedTests", 0), failed


def main():
    kind, log, status = sys.argv[1], pathlib.Path(sys.argv[2]), int(sys.argv[3])
    text = log.read_text(errors="replace") if log.exists() else ""
    passed, failed = {"gtest": count_gtest, "unittest": count_unittest, "vitest": count_vitest}[kind](text)
    if status != 0 and failed == 0:
        failed = 1
    print(passed, failed)


if __name__ == "__main__":
    main()
