"""Prints metrics as JSON, {"NAME LABELS": value}, as the reader of Prometheus' own Python library has them. usage: read_metrics.py FILE"""
import json
import sys

from prometheus_client.parser import text_string_to_metric_families

read = {}
for family in text_string_to_metric_families(open(sys.argv[1], encoding="utf-8", newline="").read()):
    assert family.documentation and family.type != "unknown", family
    for sample in family.samples:
        key = " ".join([sample.name, *(f"{name}={value}" for name, value in sorted(sample.labels.items()))])
        assert key not in read, key
        read[key] = str(sample.value)
print(json.dumps(read))
