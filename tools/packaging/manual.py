#!/usr/bin/env python3
"""Makes a program's man page and its bash completion from the text of its --help.

usage: manual.py PROGRAM VERSION MAN-PAGE COMPLETION OTHER-PROGRAM...
"""
import re
import subprocess
import sys
from pathlib import Path

# The column of descriptions in CLI11's help.
COLUMN = 30


class Help:
    """The text of one --help: its first paragraph, usage and sections.

    An entry of a section is (names and type, description); a section without entries is text for a person.
    """

    def __init__(self, command):
        text = subprocess.run(command + ["--help"], check=True, capture_output=True, text=True).stdout
        about, usage, rest = re.fullmatch(r"(.*?)^Usage: ([^\n]*)\n(.*)", text, re.DOTALL | re.MULTILINE).groups()
        self.about, self.usage = about.strip(), usage
        self.sections = []
        for block in re.split(r"^(?=[A-Z][^\n]*:$)", rest, flags=re.MULTILINE):
            if not block.strip():
                continue
            title, _, body = block.partition("\n")
            # Text without a title may follow the entries.
            listed, _, notes = body.partition("\n\n")
            if notes.strip() and entries_of(listed):
                body = listed
            else:
                notes = ""
            self.sections.append((title.rstrip(":"), entries_of(body), body))
            if notes.strip():
                self.sections.append(("Notes", [], notes))

    def options(self):
        """Every option as (its names, the only values that it takes, or an empty list)."""
        for _, entries, _ in self.sections:
            for head, _ in entries:
                if not head.startswith("-"):
                    continue
                names, _, kind = head.partition(" ")
                values = re.match(r"\w+:\{([^}]*)\}", kind)
                yield names.split(","), values.group(1).split(",") if values else []

    def subcommands(self):
        return [head for title, entries, _ in self.sections if title.startswith("Subcommands") for head, _ in entries]


def entries_of(body):
    """The entries of a section, or none if its text has another form.

    A description stands beside its names, or on the next line if they are too long for the column.
    """
    entries = []
    lines = body.splitlines()
    for line, following in zip(lines, lines[1:] + [""]):
        if not line.strip():
            continue
        if line.startswith(" " * COLUMN) and entries:
            entries[-1][1] += (" " if entries[-1][1] else "") + line.strip()
        elif re.match(r"  \S", line):
            is_long = following.startswith(" " * COLUMN) and line[COLUMN - 2:COLUMN] != "  "
            split = line[COLUMN - 1:COLUMN] == " " and line[COLUMN:] != "" and not is_long
            entries.append([line[:COLUMN].strip(), line[COLUMN:].strip()] if split else [line.strip(), ""])
        else:
            return []
    return entries if all(description or head.startswith("-") for head, description in entries) else []


def roff(text):
    text = text.replace("\\", "\\e").replace("-", "\\-").replace("'", "\\(aq").replace("`", "\\(ga")
    return re.sub(r"^\.", r"\\&.", text, flags=re.MULTILINE).replace("^", "\\(ha").replace("~", "\\(ti")


def bold_names(head):
    names, _, kind = head.partition(" ")
    return f"\\fB{roff(names)}\\fR" + (f" \\fI{roff(kind)}\\fR" if kind else "")


def sections_of(help_text, macro):
    for title, entries, body in help_text.sections:
        yield f'.{macro} "{roff(title.upper() if macro == "SH" else title)}"'
        for head, description in entries:
            yield ".TP\n" + bold_names(head) + "\n" + roff(description)
        if not entries:
            yield ".nf\n" + roff(body.strip("\n")) + "\n.fi"


def man_page(name, version, top, parts, others):
    yield f'.TH "{name.upper()}" 1 "" "Clearance {version}" "User Commands"'
    first = " ".join(re.split(r"\.\s|\.$", top.about)[0].split())
    yield f".SH NAME\n{roff(name)} \\- {roff(first)}"
    yield ".SH SYNOPSIS\n" + "\n.br\n".join(roff(help_text.usage) for help_text in [top, *parts.values()])
    yield ".SH DESCRIPTION\n" + (".nf\n" + roff(top.about) + "\n.fi" if "\n" in top.about else roff(top.about))
    yield from sections_of(top, "SH")
    for part, help_text in parts.items():
        yield f'.SH "{roff(name.upper() + " " + part.upper())}"\n' + roff(help_text.about)
        yield from sections_of(help_text, "SS")
    yield ".SH \"SEE ALSO\"\n" + ",\n".join(f"\\fB{roff(other)}\\fR(1)" for other in others if other != name)


def completion(name, top, parts):
    function = "_" + name.replace("-", "_")
    every = {"": top, **parts}
    valued, options = [], []
    for part, help_text in every.items():
        names = []
        for spellings, values in help_text.options():
            names += spellings
            if values:
                pattern = " | ".join(f'"{part} {spelling}"' for spelling in spellings)
                valued.append(f'    {pattern}) mapfile -t COMPREPLY < <(compgen -W "{" ".join(values)}" -- "$word"); return ;;')
        options.append(f'    "{part}") options="{" ".join(names)}" ;;')
    return f"""# bash completion of {name}, made from its --help
{function}() {{
  local word=${{COMP_WORDS[COMP_CWORD]}} before=${{COMP_WORDS[COMP_CWORD - 1]}} part="" options="" i
  local parts="{" ".join(parts)}"
  COMPREPLY=()
  for ((i = 1; i < COMP_CWORD; ++i)); do
    if [[ " $parts " == *" ${{COMP_WORDS[i]}} "* ]]; then part=${{COMP_WORDS[i]}}; break; fi
  done
  compopt -o filenames 2>/dev/null
  case "$part $before" in
{chr(10).join(valued + ["    *) ;;"])}
  esac
  case "$part" in
{chr(10).join(options)}
  esac
  if [[ $word == -* ]]; then mapfile -t COMPREPLY < <(compgen -W "$options" -- "$word")
  elif [[ -n $parts && -z $part ]]; then mapfile -t COMPREPLY < <(compgen -W "$parts" -- "$word")
  else mapfile -t COMPREPLY < <(compgen -f -- "$word")
  fi
}}
complete -F {function} {name}
"""


def main():
    program, version, page, completed, *others = sys.argv[1:]
    name = Path(program).name
    top = Help([program])
    parts = {part: Help([program, part]) for part in top.subcommands()}
    Path(page).write_text("\n".join(man_page(name, version, top, parts, others)) + "\n", encoding="utf-8")
    Path(completed).write_text(completion(name, top, parts), encoding="utf-8")


main()
