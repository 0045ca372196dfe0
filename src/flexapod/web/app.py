"""The web application: its routes, and how errors are answered."""

from __future__ import annotations

import contextlib
from collections.abc import AsyncIterator, Awaitable, Callable, Iterable
from functools import partial
from pathlib import Path

import anyio
from anyio.to_thread import run_sync
from starlette.applications import Starlette
from starlette.middleware import Middleware
from starlette.requests import ClientDisconnect, Request
from starlette.responses import Response, StreamingResponse
from starlette.routing import Mount, Route
from starlette.staticfiles import StaticFiles

from flexapod import __version__
from flexapod.design import design_file
from flexapod.errors import FlexapodError
from flexapod.web import description, limits, worker
from flexapod.web.answers import Refusal, Start
from flexapod.web.clients import Clients
from flexapod.web.encode import JSONAnswer
from flexapod.web.jobs import Jobs
from flexapod.web.process import Pool
from flexapod.web.questions import Answer, Questions
from flexapod.web.requests import Bodies, RequestError
from flexapod.web.security import Guard, Pace

STATIC = Path(__file__).parent / "static"


def application(start: Path | None = None, hosts: Iterable[str] = (), token: str | None = None) -> Starlette:
    """The application. start: the design file shown first; hosts: names it answers to beside localhost.

    token: what clients must know; None where only this computer can reach the server.
    """
    jobs, questions, bodies, clients = Jobs(), Questions(_presets().values()), Bodies(), Clients()

    async def begin(request: Request) -> Response:
        return JSONAnswer(await run_sync(_start, start), headers=clients.cookie(clients.who(request)))

    async def ask(request: Request) -> Response:
        kind = request.path_params["kind"]
        if kind not in worker.QUESTIONS:
            raise RequestError(f"there is no question {kind!r}", 404)
        client = clients.who(request)
        body = await bodies.read(request, client, limits.QUESTION_BYTES)
        answer = await _while_there(request, partial(questions.ask, client, kind, body))
        timing = {"server-timing": f"compute;dur={1e3 * answer.seconds:.2f}"}
        return Response(answer.content, answer.status, timing, JSONAnswer.media_type)

    async def run_job(request: Request) -> Response:
        kind = request.path_params["kind"]
        if kind not in worker.KINDS:
            raise RequestError(f"there is no job {kind!r}", 404)
        client = clients.who(request)
        body = await bodies.read(request, client, limits.JOB_BYTES)
        return StreamingResponse(jobs.run(client, kind, body), media_type="application/octet-stream")

    async def stop_job(request: Request) -> Response:
        if not jobs.cancel(request.path_params["name"]):
            raise RequestError("no such job is running", 404)
        return Response(status_code=204)

    routes = [
        Route("/api/start", begin),
        Route("/api/jobs/{kind}", run_job, methods=["POST"]),
        Route("/api/jobs/{name}", stop_job, methods=["DELETE"]),
        Route("/api/{kind}", ask, methods=["POST"]),
        Mount("/", StaticFiles(directory=STATIC, html=True)),
    ]
    app = Starlette(
        routes=routes,
        middleware=[Middleware(Pace, clients=clients), Middleware(Guard, hosts=tuple(hosts), token=token)],
        exception_handlers={FlexapodError: _refused},
        lifespan=lambda _: _warm(questions.quick.pool, jobs.pool, questions.careful.pool),
    )
    app.state.jobs, app.state.questions = jobs, questions
    return app


@contextlib.asynccontextmanager
async def _warm(*pools: Pool) -> AsyncIterator[None]:
    """Processes are started at first, one after another so that the first soon answers, and ended with the server."""

    async def start() -> None:
        for pool in pools:
            await pool.warm()

    async with anyio.create_task_group() as tasks:
        tasks.start_soon(start)
        yield
        tasks.cancel_scope.cancel()
    for pool in pools:
        pool.close()


async def _while_there(request: Request, ask: Callable[[], Awaitable[Answer]]) -> Answer:
    """The answer, which is computed as long as the client is there. Raises ClientDisconnect if it leaves."""
    found: list[Answer | RequestError] = []

    async def computed() -> None:
        try:
            found.append(await ask())
        except RequestError as error:
            found.append(error)
        tasks.cancel_scope.cancel()

    async with anyio.create_task_group() as tasks:
        tasks.start_soon(computed)
        while (await request.receive())["type"] != "http.disconnect":
            pass
        tasks.cancel_scope.cancel()
    if not found:
        raise ClientDisconnect
    if isinstance(found[0], RequestError):
        raise found[0]
    return found[0]


def _presets() -> dict[str, str]:
    """The texts of the packaged designs by their names."""
    return {name: design_file.find(name).read_text(encoding="utf-8") for name in design_file.packaged_designs()}


def _start(start: Path | None) -> Start:
    """What a new page needs first: packaged designs, the design to show, the keys of a design file."""
    return {
        "version": __version__,
        "presets": _presets(),
        "start": None if start is None else {"name": start.stem, "text": design_file.self_contained(start)},
        "fields": description.fields(),
    }


async def _refused(_: Request, error: Exception) -> Response:
    """The answer to a wrong request, or of a design file that cannot be read."""
    refusal: Refusal = {"error": str(error), "fields": []}
    return JSONAnswer(refusal, error.status if isinstance(error, RequestError) else 422)
