#!/usr/bin/env python3
"""Does unreachable.py find a dead function that is planted, and only that? Compiles small programs with $CXX (c++)."""
import contextlib
import io
import os
import pathlib
import re
import subprocess
import tempfile
import unittest

import unreachable

SOURCE = """
namespace blockrand {
#define KEPT __attribute__((noinline, noipa))
volatile int seen;
KEPT void called(int i) { seen = i; }
KEPT void helper_of_the_dead(int i) { seen = i + 1; }
KEPT void dead(int i) { helper_of_the_dead(i); }
KEPT int dead_and_recursive(int i) { return i > 9 ? i : dead_and_recursive(i + seen); }
KEPT void in_a_table(int i) { seen = i + 2; }
using Step = void (*)(int);
extern const Step kTable[2];
const Step kTable[2] = {in_a_table, called};
struct Base { virtual void run(); virtual ~Base() = default; };
KEPT void Base::run() { seen = 3; }
struct Derived : Base { void run() override; };
void Derived::run() { seen = 4; }
KEPT Base* make(int i) { return i ? new Base : new Derived; }
}  // namespace blockrand
int main(int count, char**) {
  blockrand::called(count);
  blockrand::kTable[count & 1](count);
  blockrand::make(count)->run();
}
"""
DEAD = ["blockrand::dead(int)", "blockrand::dead_and_recursive(int)", "blockrand::helper_of_the_dead(int)"]


class Unreachable(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        here = pathlib.Path(cls.folder.name)
        (here / "planted.cpp").write_text(SOURCE, encoding="utf-8")
        cls.program, cls.list = str(here / "planted"), here / "allowed.txt"
        subprocess.run([os.environ.get("CXX", "c++"), "-std=c++20", "-O2", str(here / "planted.cpp"), "-o", cls.program],
                       check=True)

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def judged(self, allowed):
        """Exit code and what was printed."""
        self.list.write_text("# Reason.\n" + "".join(f"{name}\n" for name in allowed), encoding="utf-8")
        said = io.StringIO()
        with contextlib.redirect_stdout(said):
            code = unreachable.main([self.program, str(self.list)], [""])
        if code == 77:
            self.skipTest(said.getvalue())
        return code, said.getvalue()

    def test_a_planted_dead_function_fails_the_check(self):
        code, said = self.judged([])
        self.assertEqual(code, 1)
        for name in DEAD:
            self.assertIn(f"only tests call {name}\n", said)
        self.assertIn("3 functions, 0 allowed, 3 new, 0 stale", said)

    def test_what_the_list_allows_passes(self):
        code, said = self.judged(DEAD)
        self.assertEqual(code, 0, said)

    def test_an_entry_that_is_reached_or_gone_fails_the_check(self):
        for stale in ("blockrand::called(int)", "blockrand::gone()"):
            code, said = self.judged(DEAD + [stale])
            self.assertEqual(code, 1)
            self.assertIn(f"{stale} is reached or gone", said)

    def test_a_done_row_whose_test_calls_the_dead_is_refused(self):
        ledger = ("| A01 | digs | done | `Digging.Works`, `Digging.Rests` |\n| A02 | digs | tests only | issue 3: `Digging.Works` |\n"
                  "| A03 | rests | done | `Digging.Rests` |\n")
        bodies = unreachable.bodies_of_tests([
            "TEST(Digging, Works) {\n  EXPECT_EQ(dead (3), 4);\n}\n\nTEST_F(Digging, Rests) {\n  called(2);\n  undead(1);\n}\n"])
        self.assertEqual(sorted(bodies), ["Digging.Rests", "Digging.Works"])
        said = unreachable.proved_by_the_dead(DEAD, ledger, bodies)
        self.assertEqual(said, ["A01 is done by Digging.Works, which calls dead: no command does"])
        # The page and the tests of the repository are found: every done row that names unit tests names some that are there.
        ledger, bodies = unreachable.ledger_and_tests()
        named = [t for _, reason in unreachable.DONE.findall(ledger) for t in re.findall(r"`([A-Z]\w*\.[A-Z]\w*)`", reason)]
        self.assertGreater(len(named), 200)
        self.assertGreater(sum(t in bodies for t in named), 0.9 * len(named))

    def test_calls_in_its_own_source_stand_for_inlined_ones(self):
        name = "blockrand::grammar::Run::cases[abi:cxx11](int) const"
        defined = "Value Run::cases(int i) const {\n  if (i) { return {}; }\n  return f(i);\n}\n"
        self.assertFalse(unreachable.called_in_its_source(name, [defined]))
        self.assertTrue(unreachable.called_in_its_source(name, ["Value g() {\n  return cases(2);\n}\n" + defined]))


if __name__ == "__main__":
    unittest.main()
