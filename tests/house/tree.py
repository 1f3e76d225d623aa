"""The files that the rules look at: those that git knows, or in a copy without git all but what was built."""
import collections, functools, pathlib, re, subprocess

Fault = collections.namedtuple("Fault", "rule path line text")
BUILT = re.compile(r"(^|/)(build[^/]*|node_modules|__pycache__|\.[^/]+)(/|$)")


class Tree:
    def __init__(self, root):
        self.root = pathlib.Path(root).resolve()
        listed = self.git("ls-files", "-z", "--cached", "--others", "--exclude-standard") if (self.root / ".git").exists() else None
        if listed is None:
            listed = "\0".join(str(path.relative_to(self.root)) for path in self.root.rglob("*"))
        paths = sorted(set(listed.split("\0")) - {""})
        self.paths = [path for path in paths if (self.root / path).is_file() and not BUILT.search(path)]

    def git(self, *words):
        """What git prints; None if it fails."""
        done = subprocess.run(["git", "-C", self.root, *words], capture_output=True, text=True)
        return done.stdout if done.returncode == 0 else None

    def has_history(self):
        return (self.root / ".git").exists() and (self.git("rev-parse", "--is-shallow-repository") or "").strip() == "false"

    @functools.lru_cache(maxsize=None)
    def text(self, path):
        try:
            return (self.root / path).read_text(encoding="utf-8")
        except UnicodeDecodeError:
            return ""

    def of(self, *suffixes, under=""):
        return [path for path in self.paths if path.endswith(suffixes) and path.startswith(under)]

    def scripts(self):
        """Python sources, those without a suffix, too; and scripts of the shell."""
        bare = [path for path in self.paths if "." not in path.rpartition("/")[2]]
        return self.of(".py") + [path for path in bare if self.text(path).startswith("#!")]

    def rows(self, name):
        """The rows of a list in tests/house: empty lines and comments are left out."""
        path = f"tests/house/{name}"
        if path not in self.paths:
            return
        for number, line in enumerate(self.text(path).split("\n"), 1):
            row = line.split("#")[0].strip()
            if row:
                yield f"{path}:{number}", row
