"""Holds scenario files against the JSON Schema of scenarios with Python's `jsonschema`, as they are and with slips, and prints what it
found as one JSON line.

    pip install jsonschema && python3 check_schema.py scenario.schema.json FOLDER
"""

import copy
import json
import sys
import tomllib
from pathlib import Path

from jsonschema import Draft202012Validator


def slips(value, whole, place=()):
    """The whole with an unknown key in one of its tables, or a table where one of its numbers is: one at a time."""

    def changed(change):
        mutant = copy.deepcopy(whole)
        inner = mutant
        for key in place[:-1]:
            inner = inner[key]
        change(inner)
        return mutant

    if isinstance(value, dict):
        # Kinds, clocks and sensors have names that the user chooses.
        if place not in (("kind",), ("clock",), ("sensors",)):
            if place:
                yield changed(lambda inner: inner[place[-1]].update({"no-such-key": 1}))
            else:
                yield {**whole, "no-such-key": 1}
        for key, below in value.items():
            yield from slips(below, whole, (*place, key))
    elif isinstance(value, list):
        for index, below in enumerate(value[:2]):
            yield from slips(below, whole, (*place, index))
    elif isinstance(value, (int, float)) and not isinstance(value, bool):
        yield changed(lambda inner: inner.__setitem__(place[-1], {"no-such-key": 1}))


def main(schema, folder):
    schema = json.loads(Path(schema).read_text())
    Draft202012Validator.check_schema(schema)
    validator = Draft202012Validator(schema)
    found = {"valid": 0, "invalid": 0, "refused": 0, "let_through": []}
    for path in sorted(Path(folder).glob("*.toml")):
        scenario = tomllib.loads(path.read_text())
        errors = [error.message for error in validator.iter_errors(scenario)]
        found["invalid" if errors else "valid"] += 1
        if errors:
            print(path, errors, file=sys.stderr)
        for slip in slips(scenario, scenario):
            if validator.is_valid(slip):
                found["let_through"].append(str(path.name))
            else:
                found["refused"] += 1
    print(json.dumps(found))


main(*sys.argv[1:])
