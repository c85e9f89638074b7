"""The JSON Schema accepts what is exported and agrees with the reader on shapes."""

import copy
import json
from collections.abc import Iterator
from typing import Any

import jsonschema
import pytest
from hypothesis import HealthCheck, given, settings

from tests.tuning_tables.random_tables import tables
from tuning_tables import ControllerTable, DamagedTable, OtherDecisions, from_json, table_schema, to_json
from tuning_tables.canonical import canonical_json, document_checksum

Document = dict[str, Any]
JsonPath = tuple[str | int, ...]

EXPORTED = (
    "table", "estimated_table", "approached_table", "approached_estimate", "surface_table", "surface_estimate",
)  # fmt: skip
"""A table of every version, with and without what it may have besides."""


@pytest.fixture(scope="module")
def validator() -> jsonschema.Draft202012Validator:
    jsonschema.Draft202012Validator.check_schema(table_schema())
    return jsonschema.Draft202012Validator(table_schema())


@pytest.mark.parametrize("name", ["linear_table", *EXPORTED])
def test_exported_tables_conform(
    validator: jsonschema.Draft202012Validator, request: pytest.FixtureRequest, name: str
) -> None:
    exported: ControllerTable = request.getfixturevalue(name)
    assert list(validator.iter_errors(json.loads(to_json(exported)))) == []


@given(tables())
@settings(derandomize=True, max_examples=40, deadline=None, suppress_health_check=list(HealthCheck))
def test_tables_of_every_shape_conform(validator: jsonschema.Draft202012Validator, exported: ControllerTable) -> None:
    assert list(validator.iter_errors(json.loads(to_json(exported)))) == []


def places(value: Any, path: JsonPath = ()) -> Iterator[JsonPath]:
    yield path
    members = value.items() if isinstance(value, dict) else enumerate(value) if isinstance(value, list) else ()
    for key, member in members:
        yield from places(member, (*path, key))


def altered(document: Document, path: JsonPath, value: object) -> Document:
    document = copy.deepcopy(document)
    parent: Any = document
    for key in path[:-1]:
        parent = parent[key]
    parent[path[-1]] = value
    return document


@pytest.mark.parametrize("wrong", [None, True, "", [], {}, -1], ids=repr)
@pytest.mark.parametrize("name", EXPORTED)
def test_what_the_schema_refuses_the_reader_refuses_too(
    validator: jsonschema.Draft202012Validator, request: pytest.FixtureRequest, name: str, wrong: object
) -> None:
    document = json.loads(to_json(request.getfixturevalue(name)))
    refused = 0
    for path in places(document):
        if not path or path[0] in ("format", "version", "crc32"):
            continue
        changed = altered(document, path, wrong)
        if not validator.is_valid(changed):
            refused += 1
            changed["crc32"] = document_checksum(changed)
            with pytest.raises(DamagedTable):
                from_json(canonical_json(changed))
    assert refused >= 30


@pytest.mark.parametrize("name", ["table", "surface_table"])
def test_missing_and_unknown_keys_do_not_conform(
    validator: jsonschema.Draft202012Validator, request: pytest.FixtureRequest, name: str
) -> None:
    document = json.loads(to_json(request.getfixturevalue(name)))
    objects = [path for path in places(document) if path and isinstance(value_at(document, path), dict)]
    assert len(objects) >= 9
    for key in document:
        without = {name: value for name, value in document.items() if name != key}
        # Version 5 alone may have an approach or none.
        assert validator.is_valid(without) == (key == "approach")
    for path in objects:
        content = value_at(document, path)
        assert not validator.is_valid(altered(document, path, {**content, "surplus": 1}))
        for key in content:
            assert not validator.is_valid(altered(document, path, {k: v for k, v in content.items() if k != key}))


def value_at(document: Document, path: JsonPath) -> Any:
    value: Any = document
    for key in path:
        value = value[key]
    return value


def test_an_estimator_and_its_version_belong_together(
    validator: jsonschema.Draft202012Validator, table: ControllerTable, estimated_table: ControllerTable
) -> None:
    plain, extended = json.loads(to_json(table)), json.loads(to_json(estimated_table))
    assert (plain["version"], extended["version"]) == (1, 2)
    without = {key: value for key, value in extended.items() if key != "estimator"}
    simulated = {**plain, "predicted": extended["predicted"]}
    for wrong in ({**extended, "version": 1}, {**plain, "version": 2}, without, {**without, "version": 1}, simulated):
        assert not validator.is_valid(wrong)
        wrong["crc32"] = document_checksum(wrong)
        with pytest.raises(DamagedTable):
            from_json(canonical_json(wrong))


def test_an_approach_and_its_version_belong_together(
    validator: jsonschema.Draft202012Validator, approached_table: ControllerTable, approached_estimate: ControllerTable
) -> None:
    for exported in (approached_table, approached_estimate):
        document = json.loads(to_json(exported))
        assert document["version"] == 3
        without = {key: value for key, value in document.items() if key != "approach"}
        other = {**document, "approach": {**document["approach"], "interlock": "none"}}
        for wrong in ({**document, "version": 1}, {**document, "version": 2}, without, other):
            assert not validator.is_valid(wrong)
            wrong["crc32"] = document_checksum(wrong)
            with pytest.raises(DamagedTable):
                from_json(canonical_json(wrong))


def test_times_of_decision_and_version_5_belong_together(
    validator: jsonschema.Draft202012Validator, surface_table: ControllerTable, surface_estimate: ControllerTable
) -> None:
    for exported in (surface_table, surface_estimate):
        document = json.loads(to_json(exported))
        other = "none" if document["pressure"] == "gauge" else "gauge"
        without = [{k: v for k, v in document.items() if k != key} for key in ("decisions", "pressure")]
        changed = [{**document, "version": version} for version in (1, 2, 3, 4)]
        changed += [{**document, "pressure": other}, {**document, "decisions": "at_rest"}]
        for wrong in (*without, *changed):
            assert not validator.is_valid(wrong)
            wrong["crc32"] = document_checksum(wrong)
            with pytest.raises(OtherDecisions if wrong["version"] == 4 else DamagedTable):
                from_json(canonical_json(wrong))
