"""The evidence as a page that stands alone."""
from html import escape

STYLE = """body{font:15px/1.45 sans-serif;max-width:75em;margin:2em auto;padding:0 1em}table{border-collapse:collapse;width:100%}
td,th{border:1px solid #bbb;padding:.3em .6em;text-align:left;vertical-align:top}.passed{color:#060}.bad{color:#b00;font-weight:bold}
.none{background:#fff3d6}code{font-size:90%}"""


def cell(text):
    return f"<td>{escape(str(text))}</td>"


def row(*cells):
    return "<tr>" + "".join(cells) + "</tr>"


def tests(entry):
    def one(test):
        kind = "passed" if test["outcome"] == "passed" else "bad"
        cases = f", {test['cases']} cases" if test["cases"] > 1 else ""
        return f"<code>{escape(test['name'])}</code>: <span class={kind}>{escape(test['outcome'])}</span>{cases}"
    return "<td>" + "<br>".join(map(one, entry["tests"])) + "</td>"


def promises(evidence):
    of = [entry for entry in evidence["matrix"] if entry["kind"] == "promise"]
    return "".join(row(cell(entry["id"]), cell(entry["text"]), tests(entry)) for entry in of)


def assumptions(evidence):
    def one(entry):
        answer = entry["detected_by"]
        mark = " class=none" if answer == "none" else ""
        why = f": {entry['why']}" if entry.get("why") else ""
        return row(cell(entry["id"]), cell(entry["text"]), f"<td{mark}>{escape(answer + why)}</td>", tests(entry))
    return "".join(one(entry) for entry in evidence["matrix"] if entry["kind"] == "assumption")


def facts(of):
    return "".join(row(f"<th>{escape(key)}</th>", cell("; ".join(value) if isinstance(value, list) else value))
                   for key, value in of.items())


def times(entry):
    return "<td>" + "<br>".join(
        f"{escape(time['kind'])}: {time['p50_ticks']} / {time['max_ticks']} <small>of {time['runs']}</small>"
        for time in entry["times"]) + "</td>"


def fmea(evidence):
    return "".join(row(*(cell(entry[of]) for of in ("section", "cause", "effect", "detection")), times(entry),
                       cell(entry["reaction"]),
                       cell("; ".join([*sorted({time["test"] for time in entry["times"]}), entry["test"]])))
                   for entry in evidence["fmea"])


def coverage(evidence):
    return "".join(row(cell(room), *(cell(f"{of[kind]} % of {of[kind + '_of']}; at least {of['at_least'][kind]} %")
                                     for kind in ("branches", "mcdc")))
                   for room, of in evidence["long_runs"]["coverage"].get("rooms", {}).items())


def libraries(evidence):
    return "".join(row(cell(each["name"]), cell(each.get("versionInfo", "")), cell(each.get("sourceInfo", "")),
                       cell(each.get("licenseComments", each["licenseDeclared"])))
                   for each in evidence["libraries"]["packages"])


def of(evidence):
    faults = "".join(f"<li class=bad>{escape(fault)}</li>" for fault in evidence["faults"]) or "<li>none</li>"
    commands = [command[:160] + ("..." if len(command) > 160 else "") for command in evidence["commands"]]
    changed = evidence["changed_files"]
    commit = evidence["commit"] + (f", with {len(changed)} changed files" if changed else "")
    return f"""<!doctype html><html lang="en"><meta charset="utf-8"><title>Clearance: evidence</title><style>{STYLE}</style>
<h1>Clearance: evidence</h1><p><b>{escape(evidence['statement'])}</b> How to read it: tools/EVIDENCE.md.</p>
<h2>Faults of this run</h2><ul>{faults}</ul>
<h2>What was run</h2><table>{facts({'commit': commit, 'built': evidence['built'], 'time': evidence['time'], 'minutes': evidence['minutes'], **evidence['machine']})}
{facts(evidence['build'])}{facts({'commands (whole in evidence.json)': commands, 'random cases': evidence['random_cases']})}
{facts({name: run['outcome'] for name, run in evidence['long_runs'].items()})}{facts({'not run': evidence['not_run']})}</table>
<h2>Promises</h2><table><tr><th>id<th>promise<th>tests in this run</tr>{promises(evidence)}</table>
<h2>Assumptions of use</h2><table><tr><th>id<th>assumption<th>what detects a breach<th>tests in this run</tr>
{assumptions(evidence)}</table>
<h2>Faults: cause, effect, detection, reaction</h2><p>The rows are those of monitor/FAULTS.md. Times are in
ticks of 1 ms, from the beginning of a fault until it is told: median / longest of the runs, by kind. They come from the
campaign of inputs that lie, and from tools/soak, which looks a hundred times a second.
A row without an effect has the one that FAULTS.md states first: bounds are wider or unknown, and nothing unknown is clear.</p>
<table><tr><th>section<th>cause<th>effect<th>detection<th>time until detected<th>reaction<th>tests</tr>{fmea(evidence)}</table>
<h2>Coverage</h2><table><tr><th>room<th>branches<th>MC/DC</tr>{coverage(evidence)}</table>
<h2>Libraries</h2><p>The same list as SPDX: sbom.spdx.json.</p>
<table><tr><th>name<th>version<th>source<th>licence</tr>{libraries(evidence)}</table></html>
"""
