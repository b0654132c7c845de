"""CLI: ``sphframe watch``: a page on this machine that shows a run while it is running."""

import contextlib
import errno
import json
import sys
import webbrowser
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from importlib.resources import files
from pathlib import Path
from typing import Any

from sphframe.analysis.live import LiveRun
from sphframe.errors import InputError

_HOST = "127.0.0.1"


class WatchServer(ThreadingHTTPServer):
    """Serves the page at ``/`` and its content at ``/state.json`` and ``/picture.png``, to this machine only.

    Parameters
    ----------
    run
        the run to show.
    port
        port of the page; 0 for any free one.

    Raises
    ------
    InputError
        the port cannot be used.
    """

    daemon_threads = True
    request_queue_size = 128  # many pages may ask at once, and the default is 5

    def __init__(self, run: LiveRun, port: int) -> None:
        self.run = run
        try:
            super().__init__((_HOST, port), _Handler)
        except OSError as error:
            taken = error.errno == errno.EADDRINUSE
            raise InputError(
                f"port {port} {'is taken by another program' if taken else f'cannot be used: {error.strerror}'};"
                " give another --port, or --port 0 for any free one"
            ) from None

    def handle_error(self, request: Any, client_address: Any) -> None:
        """Say nothing of clients that leave or send nothing; report anything else."""
        if not isinstance(sys.exception(), OSError):
            super().handle_error(request, client_address)

    @property
    def address(self) -> str:
        """Address of the page."""
        return f"http://{_HOST}:{self.server_port}/"


class _Handler(BaseHTTPRequestHandler):
    server: WatchServer
    timeout = 10.0  # s that a client may send nothing

    def do_GET(self) -> None:
        if self.headers.get("Host") not in {f"{name}:{self.server.server_port}" for name in (_HOST, "localhost")}:
            self.send_error(403)  # the request of a foreign page whose host name resolves to this machine
            return
        match self.path.partition("?")[0]:
            case "/":
                self._answer("text/html; charset=utf-8", files("sphframe.cli").joinpath("watch.html").read_bytes())
            case "/state.json":
                look = self.server.run.look()
                state = {
                    "file": self.server.run.path.name,
                    "status": look.status,
                    "message": look.message,
                    "facts": look.facts,
                    "drawn": look.drawn,
                }
                self._answer("application/json", json.dumps(state).encode())
            case "/picture.png" if self.server.run.latest.picture:
                self._answer("image/png", self.server.run.latest.picture)
            case _:
                self.send_error(404)

    def _answer(self, kind: str, content: bytes) -> None:
        with contextlib.suppress(ConnectionError):  # the browser has closed the connection
            self.send_response(200)
            self.send_header("Content-Type", kind)
            self.send_header("Content-Length", str(len(content)))
            self.send_header("Cache-Control", "no-store")
            self.end_headers()
            self.wfile.write(content)

    def log_message(self, *_: Any) -> None:
        """Log nothing: the page sends a request every second."""


def watch_command(path: Path, *, field: str, port: int, open_browser: bool) -> None:
    """Show a run that is complete or still running, until Ctrl-C."""
    with WatchServer(LiveRun(path, field=field), port) as server, contextlib.suppress(KeyboardInterrupt):
        print(f"{path} is shown at {server.address} (Ctrl-C ends this)", flush=True)
        if open_browser:
            webbrowser.open(server.address)
        server.serve_forever()
