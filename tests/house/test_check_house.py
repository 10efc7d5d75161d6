#!/usr/bin/env python3
"""Each rule of check_house.py finds its breach in a small made-up tree, and a clean tree passes."""
import tempfile
import unittest
from pathlib import Path

import check_house

HEADER = "#pragma once\n"


class HouseRules(unittest.TestCase):
    def found(self, **files):
        """Findings in a tree with these files; `__` stands for `/` and `_dot_` for `.` in the names."""
        with tempfile.TemporaryDirectory() as folder:
            root = Path(folder)
            (root / "tests").mkdir()
            for name, text in files.items():
                path = root / name.replace("__", "/").replace("_dot_", ".")
                path.parent.mkdir(parents=True, exist_ok=True)
                path.write_text(text)
            return list(check_house.findings(root))

    def expect_one(self, words, **files):
        found = self.found(**files)
        self.assertEqual(len(found), 1, found)
        self.assertIn(words, found[0])

    def test_clean_tree(self):
        self.assertEqual(self.found(
            src__core__a_dot_h=HEADER,
            src__deck__b_dot_cpp='#include "core/a.h"\n#include <vector>\n',
            src__geometry__box_dot_cpp='static const Register<Shape, Box> registered{"box"};\n',
            src__main_dot_cpp='#include "core/a.h"\n',
            tests__core__test_a_dot_cpp='TEST_SUITE("core") {}\n'), [])

    def test_upward_include(self):
        self.expect_one("higher room deck", src__deck__a_dot_h=HEADER,
                        src__core__b_dot_cpp='\n#include "deck/a.h"\n')

    def test_missing_include(self):
        self.expect_one("no file below src/", src__core__b_dot_cpp='#include "b.h"\n')

    def test_neighbours_may_include_one_way_only(self):
        one_way = dict(src__solve__a_dot_h=HEADER + '#include "output/b.h"\n', src__output__b_dot_h=HEADER)
        self.assertEqual(self.found(**one_way), [])
        found = self.found(**one_way, src__output__c_dot_cpp='#include "solve/a.h"\n')
        self.assertEqual(len([f for f in found if "include each other" in f]), 2, found)

    def test_model(self):
        chain = dict(src__deck__model_dot_h=HEADER,
                     src__materials__a_dot_h=HEADER + '#include "deck/model.h"\n')
        self.assertEqual(self.found(**chain), [])
        self.expect_one("includes the model", **chain,
                        src__effects__b_dot_cpp='#include "materials/a.h"\n')

    def test_unknown_room(self):
        self.expect_one("no room of the house", src__attic__a_dot_h=HEADER)
        self.expect_one("in no room", src__a_dot_cpp="")

    def test_length(self):
        self.expect_one("longer", src__core__a_dot_cpp="\n" * (check_house.MAX_LINES + 1))
        self.assertEqual(self.found(src__core__a_dot_cpp="\n" * check_house.MAX_LINES), [])

    def test_one_type_a_name(self):
        self.expect_one("is a type of src/core/a.h", src__core__a_dot_h=HEADER + "struct Box {\n};\n",
                        src__core__b_dot_h=HEADER + "class Box final : Shape {\n};\n")
        self.assertEqual(self.found(src__core__a_dot_h=HEADER + "struct Box {\n};\n",
                                    src__core__b_dot_h=HEADER + "struct Box;\n"), [])

    def test_width(self):
        self.expect_one("wider", src__core__a_dot_cpp="/" * (check_house.MAX_COLUMNS + 1))
        self.assertEqual(self.found(src__core__a_dot_cpp="/" * check_house.MAX_COLUMNS), [])

    def test_texts(self):
        self.expect_one("using namespace", src__core__a_dot_h=HEADER + "using namespace std;\n")
        self.expect_one("pragma once", src__core__a_dot_h="")
        self.expect_one("macro", src__core__a_dot_cpp="# define A 1\n")
        self.expect_one("unfinished", src__core__a_dot_cpp="// " + "TO" + "DO: later\n")

    def test_prints(self):
        for breach in ("std::cerr << 1;", "std::cout << 1;", "std::exit(1);", "exit(1);", 'printf("a");'):
            self.expect_one("only cli/ prints", src__run__a_dot_cpp=breach + "\n")
        self.assertEqual(self.found(src__cli__a_dot_cpp="std::cerr << 1;\n",
                                    src__main_dot_cpp="std::cout << 1;\n",
                                    src__run__a_dot_cpp="// no std::cerr\nint a = run.exit(1);\n"), [])

    def test_names(self):
        box = 'static const Register<Shape, Box> registered{"box"};\n'
        drag = 'EffectInfo info() { return {"drag"}; }\nconst RegisterEffect<Drag> registered;\n'
        self.assertEqual(self.found(src__geometry__box_dot_cpp=box, src__effects__drag_dot_cpp=drag), [])
        self.expect_one("registers box", src__geometry__boxes_dot_cpp=box)
        self.expect_one("registers drag", src__effects__darcy_dot_cpp=drag)
        self.expect_one("registers something",
                        src__effects__drag_dot_cpp="const RegisterEffect<Drag> registered;\n")

    def test_suites(self):
        self.expect_one("TEST_SUITE", tests__core__test_a_dot_cpp='TEST_SUITE("deck") {}\n')
        self.expect_one("TEST_SUITE", tests__core__test_a_dot_cpp="")


if __name__ == "__main__":
    unittest.main(verbosity=0)
