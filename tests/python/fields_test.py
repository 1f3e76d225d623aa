"""A report has every field of its message: one that is new in idl/clearance.idl is in Python, too."""

import pathlib
import re
import time

import clearance

IDL = pathlib.Path(__file__).resolve().parents[2] / "idl/clearance.idl"
LIMIT_S = 30.0


def fields_of(name):
    """The types and names of the members of a struct, as its IDL says."""
    text = re.sub(r"//[^\n]*", "", IDL.read_text())
    body = re.search(r"struct " + name + r"\s*\{(.*?)\};", text, re.S).group(1)
    return {field: kind.strip() for kind, field in re.findall(r"([^;\n]+?)\s+(\w+)(?:\[\d*\])?;", body)}


def test_the_idl_is_read_as_it_is_written():
    assert fields_of("SourceUse") == {"source": "string<32>", "sequence_number": "unsigned long long"}


def test_a_report_has_the_fields_of_the_message():
    missing = set(fields_of("Distances")) - set(dir(clearance.Report))
    assert not missing, missing


def test_records_have_the_fields_of_their_messages(run_daemon, planar_file):
    stopping = "urdf: planar.urdf, stopping: {reaction_ms: 50, time_ms: 200}"
    cell = planar_file.read_text().replace("urdf: planar.urdf", stopping)
    planar_file.write_text(cell.replace("max_speed: 100", "max_speed: 1"))
    daemon = run_daemon(planar_file)
    with clearance.Reports(daemon.connection(), separation=True) as reports:
        report = reports.next(LIMIT_S)
        assert report is not None
        records = {
            "PairDistance": report.pairs,
            "ContactState": report.contacts,
            "HiddenState": report.hidden,
            "RobotStop": report.stops,
        }
        if report.separated_zones is not None:
            records |= {
                "ZoneSeparation": report.separated_zones,
                "PairSeparation": report.separated_pairs,
            }
        for name, rows in records.items():
            assert set(rows.dtype.names) == set(fields_of(name)), name
        for zone in reports.zones.values():  # `name` is the key of the dict
            assert set(zone.dtype.names) == set(fields_of("ZoneState")) - {"name"}
        assert all(set(use) == set(fields_of("SourceUse")) for use in report.sources)
        assert report.active_zones.dtype == "uint32"


def test_health_has_the_fields_of_the_message(run_daemon, planar_file):
    daemon = run_daemon(planar_file)
    with clearance.Reports(daemon.connection()) as reports:
        end = time.monotonic() + LIMIT_S
        while (health := reports.health) is None and time.monotonic() < end:
            time.sleep(0.05)
        assert health is not None and reports.refused == ""
        assert set(health) == set(fields_of("Health"))
        for name, rows in {"InputAge": health["inputs"], "JointAge": health["joints"]}.items():
            assert rows and all(set(row) == set(fields_of(name)) for row in rows), name
        assert set(health["partner"]) == set(fields_of("PartnerHealth"))
