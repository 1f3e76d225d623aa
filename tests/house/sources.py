"""What the sources hold: comments, names and functions, by one scan that knows comments and texts but no grammar.

What it does not see: what macros make, code under an `#if` that closes a brace which another branch opened, functions of
JavaScript and of shell scripts, and lambdas as functions of their own (they count as lines of the function around them).
"""
import ast, collections, re

# A block of lines, without its marks. Is it alone, or behind code?
Comment = collections.namedtuple("Comment", "line text is_alone")
Function = collections.namedtuple("Function", "line lines name")  # from the first line of its declaration to its last

_TOKEN = re.compile(r"""(?=[/"'RuUL])(?:
    (?P<line>//(?:[^\n\\]|\\.)*)
  | (?P<block>/\*.*?\*/)
  | (?P<raw>\b(?:u8|[uUL])?R"(?P<mark>[^()\\\s]{0,16})\(.*?\)(?P=mark)")
  | (?P<text>"(?:[^"\\\n]|\\.)*")
  | (?P<character>(?<![0-9A-Fa-f_])'(?:[^'\\\n]|\\.)+'))
""", re.VERBOSE | re.DOTALL)
_NAME = re.compile(r"[A-Za-z_]\w*")
_DIRECTIVE = re.compile(r"^[ \t]*#(?:[^\n\\]|\\.)*", re.MULTILINE | re.DOTALL)


def _blank(text):
    return re.sub(r"[^\n]", " ", text)


class CppSource:
    """One source of C++. `code` has its lines, with blanks for comments, texts and directives."""

    def __init__(self, text):
        self.texts, comments, at, line = [], [], 0, 1

        def drop(found):
            nonlocal at, line
            if found["line"] or found["block"]:
                line += text.count("\n", at, found.start())
                at = found.start()
                begin = text.rfind("\n", 0, at) + 1
                comments.append((line, at - begin, found[0], not text[begin:at].strip()))
                return _blank(found[0])
            self.texts.append(found[0])
            return '""' + _blank(found[0][2:]) if found["text"] or found["raw"] else "0" + _blank(found[0][1:])

        self.code = _DIRECTIVE.sub(lambda found: _blank(found[0]), _TOKEN.sub(drop, text))
        self.comments = _blocks(comments)

    def names(self):
        """Each name with the line of its first use."""
        found = {}
        for number, line in enumerate(self.code.split("\n"), 1):
            for name in _NAME.findall(line):
                found.setdefault(name, number)
        return found

    def functions(self):
        """The functions, by their braces: a brace after parameters, outside of any other function, begins one.

        None if the braces do not close each other, as where two branches of an `#if` open one each.
        """
        found, outer, begin = [], [], 0  # outer: the open braces of scopes; begin: where the declaration begins
        inside, start = 0, 0  # the open braces of a function or an initialiser, and where it began
        is_function, parentheses = False, 0
        for brace in re.finditer(r"[{};()]", self.code):
            at, c = brace.start(), brace[0]
            if inside:
                inside += (c == "{") - (c == "}")
                if inside == 0 and is_function:
                    first = begin + len(self.code[begin:at]) - len(self.code[begin:at].lstrip())
                    line = self.code.count("\n", 0, first) + 1
                    lines = self.code.count("\n", first, at) + 1
                    found.append(Function(line, lines, _function_name(self.code[first:start])))
                    begin = at + 1
                continue
            if c in "()":
                parentheses += 1 if c == "(" else -1
            elif c == ";" and parentheses == 0:
                begin = at + 1
            elif c == "}":
                if not outer:
                    return None
                outer.pop()
                begin = at + 1
            elif c == "{":
                kind = "initialiser" if parentheses else _kind(self.code[begin:at])
                if kind == "scope":
                    outer.append(kind)
                    begin = at + 1
                else:
                    inside, start, is_function = 1, at, kind == "function"
        return None if outer or inside else found


def _kind(declaration):
    """What a brace after this text begins: scope, function or initialiser."""
    text = re.sub(r"^(?:\s*(?:public|private|protected)\s*:)+", "", declaration)
    text = re.sub(r"\[\[.*?\]\]|\balignas\s*\([^()]*\)", "", text, flags=re.DOTALL).strip()
    text = re.sub(r"\boperator\s*(?:\(\)|\[\]|[^\s\w(]+)", "operator_name", text)
    if re.match(r"(?:inline\s+)?namespace\b", text) or re.fullmatch(r'extern\s*""\s*', text):
        return "scope"
    bare = _without_brackets(text)
    if re.match(r"(?:(?:template\s*<>|typedef|static|inline|constexpr|const)\s*)*(?:class|struct|union|enum)\b", bare):
        if "()" not in bare and "=" not in bare:
            return "scope"
    if "()" not in bare or "=" in re.sub(r"[=!<>]=", "", bare.split("()", 1)[0]):
        # A lambda that a constant holds is a function, too.
        return "function" if re.search(r"=\s*\[", text) and bare.endswith((")", "mutable", "noexcept")) else "initialiser"
    if re.search(r"\)\s*(?:noexcept\s*)?(?:\(\)\s*)?:(?!:)", bare):  # members are initialised
        return "function" if text.endswith((")", "}")) else "initialiser"
    return "function"


def _without_brackets(text):
    """The text with what is in (), {} and <> left out."""
    for pattern, empty in ((r"\([^()]*\)", "\1"), (r"\{[^{}]*\}", " "), (r"<[^<>;]*>", "<>")):
        before = None
        while before != text:
            before, text = text, re.sub(pattern, empty, text)
    return text.replace("\1", "()")


def _function_name(declaration):
    found = re.search(r"([~\w:]+|operator\s*\S+)\s*\(([^()]*)", declaration)
    if not found:
        return declaration.split("=")[0].strip()[:60]
    return f"{found[1]}({' '.join(found[2].split())})" if found[1].startswith("TEST") else found[1]


def _blocks(comments):
    """Joins comments that stand below each other in one column."""
    blocks, last = [], None
    for line, column, text, is_alone in comments:
        if text.startswith("/*"):
            words = " ".join(part.strip(" *") for part in text[2:-2].split("\n")).strip()
        else:
            words = text.lstrip("/").strip()
        goes_on = last == (line - 1, column) and is_alone  # an empty line separates paragraphs of one comment
        if goes_on and words:
            blocks[-1] = blocks[-1]._replace(text=f"{blocks[-1].text} {words}")
        elif words:
            blocks.append(Comment(line, words, is_alone))
        last = (line, column) if words or goes_on else None
    return blocks


def python_functions(text):
    """The functions of a Python source."""
    nodes = (node for node in ast.walk(ast.parse(text)) if isinstance(node, (ast.FunctionDef, ast.AsyncFunctionDef)))
    return [Function(node.lineno, node.end_lineno - node.lineno + 1, node.name) for node in nodes]


def hash_comments(text):
    """The comments of a source whose comments begin with #, and the texts below Python's definitions left out."""
    found = []
    for number, line in enumerate(text.split("\n"), 1):
        if (at := re.match(r"^\s*#(?!!) ?(.*)$|^[^'\"#]*\s#(?!!) (.*)$", line)):
            found.append((number, line.index("#"), "//" + (at[1] or at[2] or ""), bool(at[1])))
    return _blocks(found)
