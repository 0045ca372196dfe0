"""The server's answers have the types that it declares, and the page's TypeScript types are made from these."""

import json
import runpy
from collections.abc import Iterator
from pathlib import Path
from types import UnionType
from typing import Annotated, Any, Literal, Union, get_args, get_origin, get_type_hints, is_typeddict

import pytest

pytest.importorskip("starlette")
import numpy as np
from starlette.testclient import TestClient
from tests.helpers.support import MACHINES

from flexapod.design import design_file
from flexapod.web import answers, simulation, workspace
from flexapod.web.app import application
from flexapod.web.encode import as_json, float32

TEXTS = {name: design_file.find(name).read_text(encoding="utf-8") for name in MACHINES}
ASKED = {"design": TEXTS["mukherjee-ii"], "pose": [0.001, 0.0, 0.086, 1.0, 2.0, 3.0]}
BOX = {"low": [-0.01, -0.01, 0.08, -5, -5, -5], "high": [0.01, 0.01, 0.09, 5, 5, 5]}


def misfits(value: Any, annotation: Any, path: str = "answer") -> Iterator[str]:
    """Where decoded JSON is not of a type of flexapod.web.answers."""
    origin, args = get_origin(annotation), get_args(annotation)
    if is_typeddict(annotation):
        hints = get_type_hints(annotation, include_extras=True)
        if not isinstance(value, dict) or value.keys() != hints.keys():
            yield f"{path} is {value!r:.80}; its keys must be {list(hints)}"
            return
        for name, hint in hints.items():
            yield from misfits(value[name], hint, f"{path}.{name}")
    elif origin in (Union, UnionType):
        if all(any(misfits(value, one)) for one in args):
            yield f"{path} is {value!r:.80}: none of {args}"
    elif origin is list or (origin is Annotated and args[1].depth):
        inner = args[0] if origin is list else Annotated[float, args[1]._replace(depth=args[1].depth - 1)]
        if not isinstance(value, list):
            yield f"{path} is {value!r:.80}, not a list"
            return
        for i, item in enumerate(value):
            yield from misfits(item, inner, f"{path}[{i}]")
    elif origin is tuple:
        for i, (item, inner) in enumerate(zip(value, args, strict=True)):
            yield from misfits(item, inner, f"{path}[{i}]")
    elif origin is dict:
        for key, item in value.items():
            yield from misfits(item, args[1], f"{path}.{key}")
    elif not _is_plain(value, annotation):
        yield f"{path} is {value!r:.80}, not {annotation}"


def _is_plain(value: Any, annotation: Any) -> bool:
    if get_origin(annotation) is Literal:
        return value in get_args(annotation)
    if get_origin(annotation) is Annotated:
        return (value is None and get_args(annotation)[1].nullable) or _is_plain(value, float)
    if annotation is Any:
        return True
    if annotation in (float, int):
        return isinstance(value, (int, float) if annotation is float else int) and not isinstance(value, bool)
    return isinstance(value, type(None) if annotation is None else annotation)


def fits(value: Any, annotation: Any) -> None:
    assert list(misfits(value, annotation)) == []


@pytest.fixture(scope="module")
def client() -> Iterator[TestClient]:
    with TestClient(application(), base_url="http://127.0.0.1:8765") as client:
        yield client


def test_what_a_page_starts_with_has_its_type(client: TestClient, tmp_path: Path) -> None:
    fits(client.get("/api/start").json(), answers.Start)
    own = tmp_path / "own.toml"
    own.write_text(ASKED["design"])
    with TestClient(application(own), base_url="http://127.0.0.1:8765") as other:
        fits(other.get("/api/start").json(), answers.Start)


@pytest.mark.parametrize("name", TEXTS)
def test_designs_states_and_responses_have_their_types(name: str, client: TestClient) -> None:
    design = client.post("/api/design", json={"design": TEXTS[name]}).json()
    fits(design, answers.Design)
    asked = {"design": TEXTS[name], "pose": design["home"]}
    fits(client.post("/api/state", json=asked).json(), answers.Snapshot)
    for quantity in ("absolute", "leg_force"):
        fits(client.post("/api/response", json=asked | {"quantity": quantity}).json(), answers.FrequencyResponse)
    fits(client.post("/api/shake", json=asked | {"omega": 100.0}).json(), answers.ShakenBase)


def test_a_singular_pose_has_the_type_of_any_other(client: TestClient) -> None:
    base = client.post("/api/state", json=ASKED).json()["geometry"]["base"]
    flat = ASKED | {
        "pose": [0.0] * 6,
        "changes": {"base.joints": base, "platform.joints": [[0.6 * x, 0.6 * y, 0.0] for x, y, _ in base]},
    }
    state = client.post("/api/state", json=flat).json()
    assert state["damped"] is None
    fits(state, answers.Snapshot)


def test_refusals_have_their_type(client: TestClient) -> None:
    for asked in ({"design": ""}, {"design": "[base"}, ASKED | {"changes": {"platform.mass": -1}}, {"design": 4}):
        answer = client.post("/api/design", json=asked)
        assert answer.status_code == 422
        fits(answer.json(), answers.Refusal)
    answer = client.post("/api/design", json=ASKED, headers={"origin": "https://evil.example"})
    assert answer.status_code == 403
    fits(answer.json(), answers.Refusal)


@pytest.mark.parametrize(
    ("job", "spec"),
    [
        (workspace.cloud, {"box": BOX, "points": 100}),
        (workspace.slice_map, {"box": BOX, "across": "x", "up": "y", "side": 3}),
        (workspace.worst, {"box": BOX}),
        (simulation.simulation, {"duration": 0.01}),
    ],
)
def test_messages_of_jobs_have_their_types(job: Any, spec: dict[str, Any]) -> None:
    for message, data in job(ASKED | spec):
        assert isinstance(data, bytes)
        fits(json.loads(as_json(message)), answers.JobMessage)


def test_numbers_beyond_those_of_the_page_are_infinite() -> None:
    told = float32(np.array([1.5, 1e300, -1e300, np.nan]))
    np.testing.assert_array_equal(np.frombuffer(told, "<f4"), [1.5, np.inf, -np.inf, np.nan])


def test_first_and_last_messages_of_jobs_have_their_types(client: TestClient) -> None:
    for spec in ({"box": BOX, "points": 100}, {"box": None}):
        content = client.post("/api/jobs/cloud", json=ASKED | spec).content
        told = []
        while content:
            head, data = (int.from_bytes(content[i : i + 4], "little") for i in (0, 4))
            told.append(json.loads(content[8 : 8 + head]))
            content = content[8 + head + data :]
        assert told[0]["type"] == "job"
        assert told[-1]["type"] == ("done" if spec["box"] else "failed")
        for message in told:
            fits(message, answers.JobMessage)


@pytest.mark.parametrize(
    "wrong",
    [
        {"error": "no", "fields": [], "more": 1},
        {"error": 1, "fields": []},
        {"error": "no", "fields": [{"key": "a", "message": "b", "line": "3"}]},
    ],
)
def test_a_wrong_answer_is_seen(wrong: Any) -> None:
    assert list(misfits(wrong, answers.Refusal))
    assert list(misfits([None], answers.Vector))
    assert list(misfits([[1.0]], answers.OptionalVector))


def test_the_page_s_types_are_those_of_the_server() -> None:
    generator = runpy.run_path(str(Path(__file__).parents[2] / "web" / "generate_answers.py"))
    assert generator["TARGET"].read_text(encoding="utf-8") == generator["text"](), "run `make web-types`"
