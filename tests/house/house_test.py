"""The rules of tests/house: a small tree in which nothing is wrong, and one planted fault for each rule.

usage: house_test.py
"""
import pathlib, shutil, subprocess, sys, tempfile, unittest

sys.dont_write_bytecode = True
HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE))
import exceptions, name_rules, page_rules, source_rules, sources
from tree import Tree

SOURCE = '''// The distance of two points.
#include "core/a.hpp"

namespace room {

// Returns how far apart they are, m.
double distance_of(const Point& a, const Point& b) {
  const char* text = "a brace { and // no comment";
  return a.x - b.x;  // m
}

}  // namespace room
'''
PROGRAM = '''void add_options(App& app) {
  app.add_option("--speed", speed, "m/s");
}
'''
READER = '''void read(MapReader& map) {
  read_length(map.optional("margin"));
}
'''
TREE = {
    "core/a.cpp": SOURCE,
    "tools/program.cpp": PROGRAM,
    "config/cell/reader.cpp": READER,
    "README.md": "# A page\n\n`--speed` sets the speed.\n\n```\nin code a line may be as long as it has to be" + " or longer" * 20 + "\n```\n",
    "config/KEYS.md": "# Keys\n\n## Index\n\n- [All](#all): `margin`\n\n## All\n\n| key | |\n|---|---|\n| `margin` | " + "word " * 25 + "|\n",
    "idl/FIELDS.md": "# Fields\n\n" + "a word\n" * 3000,
    "tools/script": "#!/usr/bin/env python3\n# Prints nothing.\ndef nothing():\n    pass\n",
    "tests/a_test.cpp": "TEST(Distance, OfAPointToItselfIsZero) { EXPECT_EQ(distance_of(p, p), 0.0); }\n",
    "tests/house/words.txt": "word way -> path\nword once a -> once per\npart way -> path\nname of_a -> a suffix\n",
    "tests/house/references.txt": "idl/FIELDS.md  # each field\n",
    "tests/house/exceptions.txt": "# none\n",
}


class House(unittest.TestCase):
    def setUp(self):
        scratch = tempfile.TemporaryDirectory()
        self.addCleanup(scratch.cleanup)
        self.root = pathlib.Path(scratch.name)
        for path, text in TREE.items():
            self.write(path, text)

    def write(self, path, text):
        (self.root / path).parent.mkdir(parents=True, exist_ok=True)
        (self.root / path).write_text(text, encoding="utf-8")

    def found(self):
        tree = Tree(self.root)
        faults = [fault for rules in (source_rules, page_rules, name_rules) for fault in rules.check(tree)]
        return [(fault.rule, fault.path, int(fault.line)) for fault in exceptions.judge(tree, faults)]

    def expect(self, rule, path, line, text):
        """This text in this file is the one fault of the tree."""
        self.write(path, text)
        self.assertEqual(self.found(), [(rule, path, line)], text[:200])
        (self.root / path).unlink()
        if path in TREE:
            self.write(path, TREE[path])

    def test_nothing_is_wrong_in_a_clean_tree(self):
        self.assertEqual(self.found(), [])

    def test_a_file_has_at_most_400_lines(self):
        self.write("core/long.cpp", "int x;\n" * 400)
        self.assertEqual(self.found(), [])
        for path in ("core/long.cpp", "core/long.hpp", "tests/long_test.cpp", "tools/long.py", "tools/page/long.js"):
            self.write("core/long.cpp", "int x;\n" * 400)
            self.expect("file-length", path, 1, "x = 1\n" * 401)

    def test_a_function_has_at_most_80_lines(self):
        body = "  x = {1, 2};\n"
        for begin in ("void f(int a = 3) {\n", "Foo::Foo(int a) : a_{a}, b_(a) {\n", "bool X::operator==(const X& x) const {\n",
                      "template <class T>\nauto f(T t) -> T {\n", 'extern "C" int f() {\n', "TEST_F(Suite, Name) {\n",
                      "struct X {\n  int a = 1;\n  std::array<int, 2> b{};\n  alignas(8) int c;\n  void f() const noexcept {\n",
                      "enum class E { kA };\nnamespace a::b {\nconst auto f = [](int x) {\n"):
            closing = "}\n" * (begin.count("{\n"))
            head = len(begin.split("void f() ")[0].split("const auto")[0].split("\n")) if begin.count("{\n") > 1 else 1
            lines = begin.count("\n") - head + 1
            self.write("core/a.cpp", begin + body * (79 - lines) + closing)
            self.assertEqual(self.found(), [], begin)
            self.expect("function-length", "core/a.cpp", head, begin + body * (80 - lines) + closing)
        self.expect("function-length", "tools/script", 2, "#!/usr/bin/env python3\ndef f():\n" + "    x = 1\n" * 80)

    def test_each_lock_of_the_product_states_what_it_guards(self):
        for text in ("std::mutex mutex_;\n", "mutable std::shared_mutex m;\n", "const std::lock_guard lock(m);\n"):
            for path in ("core/a.hpp", "monitor/a.cpp", "tools/a/b.hpp"):
                self.expect("lock", path, 1, text)
            for path in ("tests/a_test.cpp", "tools/ros2/a.cpp", "monitor/interface/mutex.hpp"):
                self.write(path, text)
                self.assertEqual(self.found(), [], path)
                (self.root / path).unlink()

    def test_braces_that_do_not_close_are_told(self):
        for text in ("void f() {\n", "}\n", "#if A\nvoid f() {\n#else\nvoid g() {\n#endif\n}\n"):
            self.expect("function-length", "core/a.cpp", 1, text)

    def test_braces_in_texts_and_comments_close_nothing(self):
        text = 'void f() {\n  g("}", \'}\', R"(})", 1\'000);  // }\n  /* } */\n' + "  x();\n" * 90 + "}\n"
        self.expect("function-length", "core/a.cpp", 1, text)

    def test_a_word_of_the_list_is_found_in_comments_pages_and_names(self):
        for path, line, text in (("core/a.cpp", 1, "// The way to the wall, m.\n"), ("core/a.cpp", 1, "int x;  // read once\n" + " " * 8 + "// a second\n"),
                                 ("core/a.cpp", 2, "int x;\ndouble way_to(int x);\n"), ("core/a.cpp", 1, "bool of_a_ = true;\n"),
                                 ("core/a.cpp", 1, "TEST(Walls, AreOutOfTheWay);\n"), ("README.md", 3, "# A page\n`--speed`\nis sent Once\ta second\n"),
                                 ("tools/script", 2, "#!/bin/sh\n# Prints the way.\n"), ("tools/page/a.js", 1, "// The way.\n")):
            self.expect("word", path, line, text)
        self.write("core/a.cpp", '// Is always on, and is `halfway` up.\nint waypoint = of_axis("one way");\n')
        self.assertEqual(self.found(), [])

    def test_a_row_of_the_list_that_cannot_be_read_is_told(self):
        self.expect("word", "tests/house/words.txt", 1, "word way\n")

    def test_a_comment_begins_with_a_verb_or_a_noun(self):
        for text in ("// Which of the two.\nint x;\n", "// It holds.\n", "// Also the last.\n", "/* And more. */\n"):
            self.expect("comment", "core/a.cpp", 1, text)
        self.expect("comment", "tools/script", 2, "#!/bin/sh\n# But not here.\n")
        self.write("core/a.cpp", "// Returns it.\n// Which one it is, the last line says.\nint x;  // its length, m\nint y;\n// Notes.\n// IT.\n")
        self.assertEqual(self.found(), [])

    def test_a_page_takes_ten_minutes_unless_it_is_a_reference(self):
        self.expect("page-length", "core/README.md", 1, "a word\n" * 1151)
        self.write("tests/house/references.txt", "idl/FIELDS.md\ncore/gone.md\n")
        self.assertEqual(self.found(), [("page-length", "core/gone.md", 1)])

    def test_a_line_of_a_page_has_at_most_120_columns(self):
        self.write("core/README.md", "a" * 59 + " " + "b" * 60 + "\n" + "- " + "https://" + "a" * 140 + "\n| " + "a " * 90 + "|\n")
        self.assertEqual(self.found(), [])
        self.expect("page-line", "core/README.md", 1, "a" * 60 + " " + "b" * 60 + "\n")

    def test_a_cell_of_the_keys_has_at_most_25_words(self):
        self.expect("cell", "config/KEYS.md", 11, TREE["config/KEYS.md"].replace("word |", "word word |"))

    def test_a_page_that_is_searched_has_an_index(self):
        self.expect("index", "config/KEYS.md", 1, TREE["config/KEYS.md"].replace("## Index", "## Content"))
        self.expect("index", "config/KEYS.md", 1, TREE["config/KEYS.md"] + "| `size` | |\n")
        self.write("monitor/FAULTS.md", "# Faults\n\n## Index\n\n## It's late\n\n| it | code |\n|---|---|\n| 1 | `[late]`, `[later]` |\n")
        self.assertEqual(self.found(), [("index", "monitor/FAULTS.md", 1)])
        subprocess.run([HERE / "reflow", self.root / "monitor/FAULTS.md"], check=True)
        self.assertIn("\n- [It's late](#its-late): `late`, `later`\n", (self.root / "monitor/FAULTS.md").read_text())
        self.assertEqual(self.found(), [])

    def test_each_option_and_key_is_named(self):
        self.expect("option", "tools/program.cpp", 1, 'app.add_flag("--spee", x);  // for --speed-limit\n')
        self.expect("option", "tools/program.cpp", 1, 'const Option kOptions[] = {{"--heat", "how warm"}};\n')
        self.expect("key", "config/cell/reader.cpp", 2, 'map.required("margin");\nmap.required("marg");\n')
        self.expect("key", "config/cell/reader.cpp", 1, 'const Row kRows[] = {{"warmth", &Cell::warmth}};\n')
        self.write("tools/program.cpp", 'app.add_flag("-h,--heat", x);\n')
        self.write("tests/a_test.cpp", 'run("clearanced --heat");\n')
        self.assertEqual(self.found(), [])

    @unittest.skipUnless(shutil.which("git"), "needs git")
    def test_the_commit_of_a_measured_page_is_in_the_history(self):
        page = "tools/bench/measured/speed.md"
        self.expect("measured", page, 1, "# Speed\n")
        self.write(page, "# Speed\n\nMeasured at commit 0123456789ab.\n")
        self.assertEqual(self.found(), [], "without a history nothing can be said")
        git = ("git", "-C", self.root, "-c", "user.name=a", "-c", "user.email=a@b")
        subprocess.run([*git, "init", "-q"], check=True)
        subprocess.run([*git, "add", "."], check=True)
        subprocess.run([*git, "commit", "-q", "-m", "a"], check=True)
        self.assertEqual(self.found(), [("measured", page, 3)])
        head = subprocess.run([*git, "rev-parse", "HEAD"], check=True, capture_output=True, text=True).stdout.strip()
        self.write(page, f"# Speed\n\nMade from 0.2.0, {head[:12]}, GNU.\n")
        self.assertEqual(self.found(), [])

    def test_exceptions_have_a_count_that_can_only_shrink(self):
        self.write("core/a.cpp", "// It is.\nint way;\n\n// It was.\n")
        self.write("tests/house/exceptions.txt", "comment core/ 2  # words\nword core/a.cpp 1\n")
        self.assertEqual(self.found(), [])
        self.write("tests/house/exceptions.txt", "comment core/ 1\nword core/a.cpp 1\n")
        self.assertEqual(self.found(), [("comment", "core/a.cpp", 1), ("comment", "core/a.cpp", 4)])
        self.write("tests/house/exceptions.txt", "comment core/ 3\nword core/a.cpp 1\n")
        self.assertEqual(self.found(), [("comment", "tests/house/exceptions.txt", 1)])
        self.write("tests/house/exceptions.txt", "# head\n\n# A group.\ncomment core/ 3  # why\nword core/a.cpp 1\n\n# Another.\ncell config/ 1\n")
        self.assertEqual(subprocess.run([HERE / "check", self.root, "--tighten"]).returncode, 0)
        self.assertEqual((self.root / "tests/house/exceptions.txt").read_text(), "# head\n\n# A group.\ncomment core/ 2  # why\nword core/a.cpp 1\n")
        self.assertEqual(self.found(), [])

    def test_the_program_prints_each_fault_and_fails(self):
        clean = subprocess.run([HERE / "check", self.root], capture_output=True, text=True)
        self.assertEqual((clean.returncode, clean.stdout, clean.stderr), (0, "", ""))
        self.write("core/a.cpp", "\n// It is.\n")
        done = subprocess.run([HERE / "check", self.root], capture_output=True, text=True)
        self.assertEqual((done.returncode, done.stdout), (1, "core/a.cpp:2: comment: begins with 'It'; begin with a verb or a noun\n"))


class Reflow(unittest.TestCase):
    def reflowed(self, text):
        with tempfile.TemporaryDirectory() as folder:
            page = pathlib.Path(folder) / "page.md"
            page.write_text(text, encoding="utf-8")
            subprocess.run([HERE / "reflow", page], check=True)
            return page.read_text(encoding="utf-8")

    def test_breaks_long_paragraphs_and_items_and_leaves_all_else(self):
        kept = "# " + "heading " * 20 + "\n\n```\n" + "code " * 40 + "\n```\n\n    " + "code " * 40 + "\n    code\n\n| " + "cell " * 40 + "|\n\nshort\nlines\n\n"
        word = "x" * 9
        text = kept + " ".join([word] * 13) + "\n\n- " + " ".join([word] * 12 + ["`code\n  that stays`"]) + "\n  after\n- next\n"
        expected = (kept + " ".join([word] * 12) + f"\n{word}\n\n- " + " ".join([word] * 11) +
                    f"\n  {word} `code that stays` after\n- next\n")
        self.assertEqual(self.reflowed(text), expected)
        self.assertEqual(self.reflowed(expected), expected)

    def test_begins_no_line_with_what_would_be_a_list_or_a_heading(self):
        for mark in ("-", "+", "#", "1.", "|x|", ">"):
            line = " ".join(["x" * 9] * 12)
            self.assertEqual(self.reflowed(f"{line} {mark} y\n"), line[:-10] + "\n" + "x" * 9 + f" {mark} y\n")


class Sources(unittest.TestCase):
    def test_lines_of_a_comment_are_one_text(self):
        code = "int a;  // the first\n        // line\nint b;  // another\n// Apart.\n//\n// It goes on.\n\n// Alone.\n"
        self.assertEqual([comment.text for comment in sources.CppSource(code).comments], ["the first line", "another", "Apart. It goes on.", "Alone."])


if __name__ == "__main__":
    unittest.main()
