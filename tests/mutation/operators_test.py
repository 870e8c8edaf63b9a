"""The operators change what they name, and leave comments, texts and templates alone."""

import sys
import unittest
from pathlib import Path

sys.dont_write_bytecode = True
sys.path.insert(0, str(Path(__file__).resolve().parent))
from operators import applied, masked, mutants_of, scaled


def mutated(line):
    text = "{\n" + line + "\n"
    return {(m.operator, applied(text, m).split("\n")[1].strip()) for m in mutants_of(text)}


class Operators(unittest.TestCase):
    def test_a_comparison_moves_its_limit_and_turns(self):
        self.assertEqual(mutated("    return a < b;"), {("comparison", "return a <= b;"), ("comparison", "return a > b;")})

    def test_a_statement_vanishes_and_a_declaration_stays(self):
        self.assertEqual(mutated("    energy_ = x;"), {("statement", ";")})
        self.assertEqual(mutated("    double energy = x;"), set())
        self.assertEqual(mutated("    return stop();"), set())

    def test_a_line_that_goes_on_is_no_statement(self):
        text = "{\n    first = a +\n    second(b);\n"
        self.assertNotIn("statement", {m.operator for m in mutants_of(text)})

    def test_signs_numbers_and_logic_change(self):
        self.assertIn(("sign", "f(x);"), mutated("    f(-x);"))
        self.assertIn(("arithmetic", "x = a + b;"), mutated("    x = a - b;"))
        self.assertIn(("logic", "if (a || b) go();"), mutated("    if (a && b) go();"))
        self.assertIn(("extreme", "x = std::max(a, b);"), mutated("    x = std::min(a, b);"))
        self.assertEqual([scaled(n) for n in ("0", "7U", "1e-3", "0.0", "2.5F", "0x1F")], ["1", "8U", "0.002", "1.0", "5.0F", "0x20"])

    def test_comments_texts_and_templates_stay(self):
        self.assertEqual(mutated("    // a < b && c"), set())
        self.assertEqual(mutated('    return "a < b";'), set())
        self.assertEqual(mutated("    std::array<double> a;"), set())
        self.assertEqual(mutated("#include <algorithm>"), set())
        self.assertEqual(masked("a /* < \n > */ b"), "a      \n      b")


if __name__ == "__main__":
    unittest.main()
