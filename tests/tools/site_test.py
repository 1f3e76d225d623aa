"""The site of the pages: no dead link, nothing from other servers, and each page as GitHub's own renderer has it.

Oracles: Python's reader of HTML, and cmark-gfm.
usage: site_test.py
"""

import collections
import html.parser
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest
import urllib.parse

sys.dont_write_bytecode = True
ROOT = pathlib.Path(__file__).resolve().parents[2]
STRUCTURE = {"li", "ol", "ul", "table", "tr", "td", "pre", "h1", "h2", "h3"}


class Page(html.parser.HTMLParser):
    """What one page links to and loads, its anchors, and the number of its elements by name."""

    def __init__(self, text):
        super().__init__()
        self.links, self.loaded, self.anchors, self.count = [], [], set(), collections.Counter()
        self.feed(text)

    def handle_starttag(self, tag, attributes):
        attributes = dict(attributes)
        self.count[tag] += 1
        self.anchors.update(attributes[key] for key in ("id", "name") if attributes.get(key))
        if tag == "a" and "href" in attributes:
            self.links.append(attributes["href"])
        elif tag in ("script", "img", "link"):
            self.loaded.append(attributes.get("src") or attributes.get("href"))


def structure(text):
    return {tag: count for tag, count in Page(text).count.items() if tag in STRUCTURE}


def make(folder, script=ROOT / "tools/site"):
    return subprocess.run([script, folder], capture_output=True, text=True, timeout=300)


class Site(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.scratch = tempfile.TemporaryDirectory()
        cls.folder = pathlib.Path(cls.scratch.name) / "site"
        cls.made = make(cls.folder)
        cls.pages = {path: Page(path.read_text(encoding="utf-8")) for path in cls.folder.rglob("*.html")}

    @classmethod
    def tearDownClass(cls):
        cls.scratch.cleanup()

    def test_is_made_of_every_page(self):
        self.assertEqual(self.made.returncode, 0, self.made.stderr)
        for room in ("", *(f"{name}/**/" for name in ("config", "core", "idl", "monitor", "tools", "tests"))):
            for page in ROOT.glob(f"{room}*.md"):
                if "node_modules" in page.parts:
                    continue
                name = "index.html" if page.name == "README.md" else page.stem + ".html"
                self.assertIn(self.folder / page.relative_to(ROOT).parent / name, self.pages)

    def test_has_no_dead_link_and_loads_nothing_from_other_servers(self):
        checked = 0
        for path, page in self.pages.items():
            if path.name in ("404.html", "search.html"):
                continue
            for link in page.links + page.loaded:
                url = urllib.parse.urlsplit(link)
                if url.scheme or url.netloc:
                    self.assertNotIn(link, page.loaded, path)
                    continue
                there = (path.parent / urllib.parse.unquote(url.path)).resolve() if url.path else path
                self.assertTrue(there.is_file(), f"{path}: {link}")
                if url.fragment:
                    self.assertIn(urllib.parse.unquote(url.fragment), self.pages[there].anchors, f"{path}: {link}")
                checked += 1
        self.assertGreater(checked, 5000)

    def test_pages_have_the_structure_that_github_shows(self):
        for path in self.folder.rglob("*.html"):
            source = ROOT / path.relative_to(self.folder).parent / ("README.md" if path.name == "index.html" else path.stem + ".md")
            if not source.is_file():
                continue
            text = path.read_text(encoding="utf-8")
            body = text.split('role="main"', 1)[1].split("<footer>", 1)[0]
            theirs = subprocess.run(["cmark-gfm", "-e", "table", source], capture_output=True, text=True, check=True).stdout
            self.assertEqual(structure(body), structure(theirs), source)

    def test_dead_links_and_headings_are_refused_by_name(self):
        for text, fault in (("[a](none.md)", "none.md"), ("[a](tools/none.hpp)", "none.hpp"), ("[a](#none)", "#none"),
                            ("[a](idl/README.md#none)", "idl/README.md#none")):
            with tempfile.TemporaryDirectory() as folder:
                root = pathlib.Path(folder)
                for name in ("tools", "idl"):
                    (root / name).mkdir()
                    (root / name / "README.md").write_text("# A page\n", encoding="utf-8")
                shutil.copy(ROOT / "tools/site", root / "tools/site")
                (root / "README.md").write_text(f"# A page\n\n[good](idl/README.md#a-page)\n\n{text}\n", encoding="utf-8")
                done = make(root / "site", root / "tools/site")
                self.assertEqual(done.returncode, 1, text)
                self.assertIn(fault, done.stderr)
                self.assertFalse((root / "site").exists())


if __name__ == "__main__":
    unittest.main()
