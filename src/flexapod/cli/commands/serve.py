"""`flexapod serve`: the hexapod in the browser."""

from __future__ import annotations

import contextlib
import json
import socket
import webbrowser
from pathlib import Path

import click

from flexapod.cli.options import common
from flexapod.errors import FlexapodError
from flexapod.optional import needed


@click.command()
@click.argument("design", required=False, type=common.DesignName())
@click.option("--port", type=click.IntRange(0, 65535), default=8765, show_default=True, help="0 takes a free one.")
@click.option("--host", default="127.0.0.1", show_default=True, help="Address to listen on.")
@click.option("--allow-host", multiple=True, metavar="NAME", help="Another name browsers may use for this server.")
@click.option("--open/--no-open", "show", default=False, help="Open the page in the browser.")
@click.option("--json", "as_json", is_flag=True, help="Print the address as one line of JSON.")
def command(design: str | None, port: int, host: str, allow_host: tuple[str, ...], show: bool, as_json: bool) -> None:
    """Open a local page with DESIGN (a packaged name or a .toml file) to play with.

    It listens on this computer only unless --host says otherwise, and asks nothing of the network. Ctrl-C ends it.
    """
    start = None if design is None else _checked(design)
    why = "`flexapod serve` needs uvicorn and starlette"
    uvicorn, _ = needed("uvicorn", "web", why), needed("starlette", "web", why)
    from flexapod.web.app import application

    bound = _listen(host, port)
    port = bound.getsockname()[1]
    shown = f"[{host}]" if ":" in host else host
    url = f"http://{'127.0.0.1' if host in ('0.0.0.0', '::') else shown}:{port}/"
    if as_json:
        click.echo(json.dumps({"url": url}))
    else:
        click.echo(f"Flexapod is at {url} (Ctrl-C ends it)")
    if show:
        webbrowser.open(url)
    app = application(start, hosts=(host, *allow_host))
    server = uvicorn.Server(uvicorn.Config(app, log_level="warning", timeout_graceful_shutdown=1))
    with contextlib.suppress(KeyboardInterrupt):  # its usual end
        server.run(sockets=[bound])


def _checked(design: str) -> Path:
    """The design's file. A file that is no design is still served: the page shows what is wrong, at its fields."""
    from flexapod.design import design_file  # loads NumPy, which `flexapod --help` does without

    path = design_file.find(design)
    try:
        design_file.read_file(path)
    except FlexapodError as error:
        click.echo(f"Note: {error}", err=True)
    return path


def _listen(host: str, port: int) -> socket.socket:
    """A socket that listens: whoever comes before the server runs waits for it."""
    family = socket.AF_INET6 if ":" in host else socket.AF_INET
    bound = socket.socket(family, socket.SOCK_STREAM)
    bound.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
    try:
        bound.bind((host, port))
        bound.listen()
    except (OSError, UnicodeError) as error:  # UnicodeError: a name that no host can have
        bound.close()
        raise click.UsageError(
            f"cannot listen on {host} port {port}: {getattr(error, 'strerror', None) or error}. Try --port 0."
        ) from error
    return bound
