"""The web application: its routes, and how errors are answered."""

from __future__ import annotations

import contextlib
import time
from collections.abc import AsyncIterator, Awaitable, Callable, Iterable, Mapping
from functools import partial
from importlib import import_module
from pathlib import Path
from typing import Any

import anyio
from anyio.to_thread import run_sync
from starlette.applications import Starlette
from starlette.middleware import Middleware
from starlette.requests import Request
from starlette.responses import Response, StreamingResponse
from starlette.routing import Mount, Route
from starlette.staticfiles import StaticFiles

from flexapod import __version__
from flexapod.design import design_file
from flexapod.errors import FlexapodError
from flexapod.web import description, requests, response, state, worker
from flexapod.web.answers import Design, Refusal, Snapshot, Start
from flexapod.web.design_errors import InvalidDesign
from flexapod.web.encode import JSONAnswer
from flexapod.web.jobs import Jobs
from flexapod.web.security import Guard

STATIC = Path(__file__).parent / "static"


def application(start: Path | None = None, hosts: Iterable[str] = ()) -> Starlette:
    """The application. start: the design file shown first; hosts: names it answers to beside localhost."""
    jobs = Jobs()

    @contextlib.asynccontextmanager
    async def lifespan(_: Starlette) -> AsyncIterator[None]:
        async with anyio.create_task_group() as tasks:
            tasks.start_soon(jobs.warm)
            tasks.start_soon(partial(run_sync, import_module, "xarray"))  # slow: before the first response needs it
            yield
            tasks.cancel_scope.cancel()
        jobs.close()

    async def begin(_: Request) -> Response:
        return JSONAnswer(await run_sync(_start, start))

    async def run_job(request: Request) -> Response:
        kind = request.path_params["kind"]
        if kind not in worker.KINDS:
            raise requests.RequestError(f"there is no job {kind!r}", 404)
        spec = await requests.body(request)
        await run_sync(requests.question, spec)
        return StreamingResponse(jobs.run(kind, spec), media_type="application/octet-stream")

    async def stop_job(request: Request) -> Response:
        if not jobs.cancel(request.path_params["name"]):
            raise requests.RequestError("no such job is running", 404)
        return Response(status_code=204)

    routes = [
        Route("/api/start", begin),
        Route("/api/design", _post(_design), methods=["POST"]),
        Route("/api/state", _post(_state), methods=["POST"]),
        Route("/api/response", _post(response.response), methods=["POST"]),
        Route("/api/shake", _post(response.shake), methods=["POST"]),
        Route("/api/jobs/{kind}", run_job, methods=["POST"]),
        Route("/api/jobs/{name}", stop_job, methods=["DELETE"]),
        Mount("/", StaticFiles(directory=STATIC, html=True)),
    ]
    app = Starlette(
        routes=routes,
        middleware=[Middleware(Guard, hosts=tuple(hosts))],
        exception_handlers={FlexapodError: _refused},
        lifespan=lifespan,
    )
    app.state.jobs = jobs
    return app


def _start(start: Path | None) -> Start:
    """What a new page needs first: packaged designs, the design to show, the keys of a design file."""
    presets = {name: design_file.find(name).read_text(encoding="utf-8") for name in design_file.packaged_designs()}
    return {
        "version": __version__,
        "presets": presets,
        "start": None if start is None else {"name": start.stem, "text": design_file.self_contained(start)},
        "fields": description.fields(),
    }


def _design(asked: dict[str, Any]) -> Design:
    return description.described(requests.source(asked))


def _state(asked: dict[str, Any]) -> Snapshot:
    return state.snapshot(requests.question(asked))


def _post(answer: Callable[[dict[str, Any]], Mapping[str, object]]) -> Callable[[Request], Awaitable[Response]]:
    """An endpoint that takes a JSON object and answers with one, computed in a thread so that others can be served."""

    async def endpoint(request: Request) -> Response:
        asked = await requests.body(request)
        began = time.perf_counter()
        result = await run_sync(answer, asked)
        spent = 1e3 * (time.perf_counter() - began)
        return JSONAnswer(result, headers={"server-timing": f"compute;dur={spent:.2f}"})

    return endpoint


async def _refused(_: Request, error: Exception) -> Response:
    """The answer to a wrong request, design or pose."""
    fields = error.errors if isinstance(error, InvalidDesign) else []
    refusal: Refusal = {"error": str(error), "fields": fields}
    status = error.status if isinstance(error, requests.RequestError) else 422
    return JSONAnswer(refusal, status)
