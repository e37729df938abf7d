#!/usr/bin/env python3
"""Tests of the scripts that judge a run of the tests."""
import unittest

import skipped_tests

LOG = """Start testing: Nov 22 18:51 UTC
----------------------------------------------------------
1/3 Testing: repair
1/3 Test: repair
Command: "test_repair"
"repair" start time: Nov 22 18:51 UTC
Output:
----------------------------------------------------------
[ RUN      ] Repair.Berlin
/src/repair_test.cpp:12: Skipped
no ../shared/data

[  SKIPPED ] Repair.Berlin (0 ms)
[ RUN      ] Repair.Hamburg
/src/repair_test.cpp:20: Skipped
no ../shared/data

[  SKIPPED ] Repair.Hamburg (0 ms)
[  PASSED  ] 3 tests.
[  SKIPPED ] 2 tests, listed below:
[  SKIPPED ] Repair.Berlin
[  SKIPPED ] Repair.Hamburg
<end of output>
Test Passed.
2/3 Testing: e2e_viewers
Output:
----------------------------------------------------------
test_blender (__main__.Viewers) ... skipped 'no blender'
test_osmium (__main__.Viewers) ... ok
<end of output>
Test Passed.
3/3 Testing: fuzz
Output:
----------------------------------------------------------
fuzz: no clang++-16: skipped
<end of output>
Test time =   0.01 sec
Test Passed.
"""


class SkippedTests(unittest.TestCase):
    def test_every_way_of_skipping_is_counted_once(self):
        self.assertEqual(skipped_tests.summary(LOG.splitlines(True)), [
            "tests: SKIPPED 4 cases of 3 tests:",
            "  e2e_viewers (1): no blender",
            "  fuzz (1): fuzz: no clang++-16: skipped",
            "  repair (2): no ../shared/data"])

    def test_a_whole_run_is_said_to_be_whole(self):
        self.assertEqual(skipped_tests.summary(["1/1 Testing: base\n", "Test Passed.\n"]),
                         ["tests: nothing was skipped"])


if __name__ == "__main__":
    unittest.main()
