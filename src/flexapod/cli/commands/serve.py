"""`flexapod serve`: the hexapod in the browser."""

from __future__ import annotations

import contextlib
import gc
import ipaddress
import json
import secrets
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
@click.option("--host", default="127.0.0.1", show_default=True, help="Address to listen on; 0.0.0.0: all.")
@click.option("--allow-host", multiple=True, metavar="NAME", help="Another name browsers may use for this server.")
@click.option("--open/--no-open", "show", default=False, help="Open the page in the browser.")
@click.option("--json", "as_json", is_flag=True, help="Print the address as one line of JSON.")
def command(design: str | None, port: int, host: str, allow_host: tuple[str, ...], show: bool, as_json: bool) -> None:
    """Open a local page with DESIGN (a packaged name or a .toml file) to play with.

    It listens on this computer only unless --host says otherwise, and asks nothing of the network. Where others can
    reach it, the address that it prints holds a token, and only who has it is answered. Ctrl-C ends it.
    """
    start = None if design is None else _checked(design)
    why = "`flexapod serve` needs uvicorn and starlette"
    needed("uvicorn", "web", why), needed("starlette", "web", why)
    from flexapod.web import forks
    from flexapod.web.app import application
    from flexapod.web.serving import Door, server

    bound = _listen(Door, host, port)
    address, port = bound.getsockname()[:2]
    open_to_others = not ipaddress.ip_address(address).is_loopback
    token = secrets.token_urlsafe(16) if open_to_others else None
    own = "127.0.0.1" if ipaddress.ip_address(address).is_unspecified else host
    part = "" if token is None else f"?token={token}"
    shown = f"[{own}]" if ":" in own else own
    url = f"http://{shown}:{port}/{part}"
    click.echo(json.dumps({"url": url}) if as_json else f"Flexapod is at {url} (Ctrl-C ends it)")
    if open_to_others:
        click.echo(
            f"Note: other computers can reach it at http://{socket.gethostname()}:{port}/{part}. Whoever has the token "
            "in the address can compute here; nothing is encrypted on its way. Without --host, only this computer can.",
            err=True,
        )
    forks.begin()  # not before the address is told, which would come later
    if show:
        webbrowser.open(url)
    hosts = (host, *allow_host, *([socket.gethostname()] if open_to_others else []))
    served = server(application(start, hosts, token))
    gc.freeze()  # all that is loaded stays: looking through it again and again took a third of the time under load
    with contextlib.suppress(KeyboardInterrupt):  # its usual end
        served.run(sockets=[bound])


def _checked(design: str) -> Path:
    """The design's file. A file that is no design is still served: the page shows what is wrong, at its fields."""
    from flexapod.design import design_file  # loads NumPy, which `flexapod --help` does without

    path = design_file.find(design)
    try:
        design_file.read_file(path)
    except FlexapodError as error:
        click.echo(f"Note: {error}", err=True)
    return path


def _listen(door: type[socket.socket], host: str, port: int) -> socket.socket:
    """A socket that listens: whoever comes before the server runs waits for it."""
    if not host.strip():
        raise click.UsageError("--host is empty, which would be every address. Leave it out for this computer only.")
    family = socket.AF_INET6 if ":" in host else socket.AF_INET
    bound = door(family, socket.SOCK_STREAM, socket.IPPROTO_TCP)  # named: or asyncio leaves its delays on
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
