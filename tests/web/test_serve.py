"""The command: its errors, its end, and what becomes of jobs whose page has gone."""

import json
import os
import signal
import socket
import subprocess
import sys
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from click.testing import CliRunner
from tests.helpers.waiting import until

from flexapod.cli import group

pytest.importorskip("uvicorn")
from tests.web.asked import LONG
from tests.web.serving import running


def test_an_unknown_design_is_refused_with_the_names() -> None:
    found = subprocess.run(
        [sys.executable, "-m", "flexapod", "serve", "nonsense"], capture_output=True, text=True, check=False
    )
    assert found.returncode == 2
    assert "mukherjee-ii" in found.stderr


def test_a_taken_port_is_told() -> None:
    with socket.socket() as taken:
        taken.bind(("127.0.0.1", 0))
        taken.listen()
        port = taken.getsockname()[1]
        found = CliRunner().invoke(group, ["serve", "--port", str(port)])
    assert found.exit_code == 2
    assert f"port {port}" in found.output
    assert "--port 0" in found.output


def gone(group: int) -> bool:
    """Whether no process of a group lives."""
    try:
        os.killpg(group, 0)
    except ProcessLookupError:
        return True
    return False


def test_ctrl_c_ends_it_and_its_processes() -> None:
    command = [sys.executable, "-m", "flexapod", "serve", "--port", "0", "--json"]
    environment = {**os.environ, "PYTHONUNBUFFERED": "1"}
    with subprocess.Popen(
        command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, env=environment, start_new_session=True
    ) as run:
        assert run.stdout is not None
        assert run.stderr is not None
        address = json.loads(run.stdout.readline())["url"]
        assert address.startswith("http://127.0.0.1:")
        time.sleep(1.0)
        os.killpg(run.pid, signal.SIGINT)  # what a terminal does: to the server and its jobs alike
        assert run.wait(timeout=60) == 0
        assert run.stderr.read() == ""
    assert until(lambda: gone(run.pid)), "a process of the group lives on"


@pytest.fixture
def app_and_port() -> Iterator[tuple[Any, int]]:
    with running() as served:
        yield served.app, served.port


def test_a_job_ends_when_its_page_goes(app_and_port: tuple[Any, int]) -> None:
    app, port = app_and_port
    body = json.dumps(LONG).encode()
    head = f"POST /api/jobs/time HTTP/1.1\r\nHost: 127.0.0.1:{port}\r\nContent-Length: {len(body)}\r\n\r\n"
    with socket.create_connection(("127.0.0.1", port)) as page:
        page.sendall(head.encode() + body)
        assert b"200 OK" in page.recv(4096)
        assert until(lambda: len(app.state.jobs.running()) == 1)
    assert until(lambda: not app.state.jobs.running())


def test_the_bundle_is_there() -> None:
    from flexapod.web.app import STATIC

    assert {"index.html", "icon.svg"} <= {path.name for path in Path(STATIC).iterdir()}
