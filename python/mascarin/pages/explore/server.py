"""The local server of `mascarin explore`.

Only this computer reaches it (127.0.0.1), and only the page that it gave out itself: each request has to name
the server's own host (against DNS rebinding) and a random token (against other pages and other users). The
page loads nothing from elsewhere.
"""

from __future__ import annotations

import errno
import json
import os
import secrets
import sys
from collections.abc import Callable, Mapping
from http import HTTPStatus
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from typing import Any, Final, cast
from urllib.parse import parse_qs, urlsplit

from mascarin.errors import InputError, MascarinError

HOST: Final = "127.0.0.1"
TOKEN: Final = "X-Mascarin-Token"  # noqa: S105  (the name of a header)
#: Most bytes of a request, and seconds without one after which a connection is closed.
_MAX_BODY, _MAX_SILENCE = 65_536, 60.0
_HEADERS: Final = {
    "Cache-Control": "no-store",
    "Content-Security-Policy": "frame-ancestors 'none'",
    "Cross-Origin-Resource-Policy": "same-origin",
    "Referrer-Policy": "no-referrer",
    "X-Content-Type-Options": "nosniff",
    "X-Frame-Options": "DENY",
}

Answer = Callable[[Mapping[str, Any]], Mapping[str, Any]]


class Server(ThreadingHTTPServer):
    """Serves one page and its requests.

    Parameters
    ----------
    page : callable
        From the token to the HTML.
    answers : mapping of str to callable
        By path, such as ``/run``: from the content of a request to that of its answer.
    port : int
        Port; 0: any that is free.

    Raises
    ------
    InputError
        The port is in use or not allowed.

    Examples
    --------
    >>> server = Server(lambda token: "<p>page</p>", {})
    >>> server.address.startswith("http://127.0.0.1:")
    True
    >>> server.server_close()
    """

    daemon_threads = True
    allow_reuse_address = os.name == "posix"  # elsewhere it would let two programs have one port

    def __init__(self, page: Callable[[str], str], answers: Mapping[str, Answer], port: int = 0) -> None:
        try:
            super().__init__((HOST, port), _Handler)
        except OverflowError:
            raise InputError(f"--port: found {port}; expected 0 to 65535") from None
        except OSError as error:
            if error.errno in (errno.EADDRINUSE, errno.EACCES) or getattr(error, "winerror", 0) == 10013:
                raise InputError(
                    f"--port: found {port}, which another program uses or which is not allowed; expected a "
                    "free port. Give another one, or leave --port out"
                ) from None
            raise
        self.token = secrets.token_urlsafe(24)
        self.answers = answers
        self.html = page(self.token).encode()

    @property
    def address(self) -> str:
        """Address of the page."""
        return f"http://{HOST}:{self.server_port}/?token={self.token}"

    def handle_error(self, request: Any, client_address: Any) -> None:
        """Ignore a browser that went away; report anything else."""
        if not isinstance(sys.exc_info()[1], ConnectionError | TimeoutError):
            super().handle_error(request, client_address)


class _Handler(BaseHTTPRequestHandler):
    protocol_version = "HTTP/1.1"
    server_version = "Mascarin"
    sys_version = ""
    disable_nagle_algorithm = True
    timeout = _MAX_SILENCE

    @property
    def _server(self) -> Server:
        return cast("Server", self.server)

    def do_GET(self) -> None:
        """Give the page."""
        if not self._is_own_host():
            return
        try:
            address = urlsplit(self.path)
        except ValueError:  # such as an open bracket, which would begin an address
            address = None
        if address is None or address.path != "/":
            self._say(HTTPStatus.NOT_FOUND, "there is nothing here")
        elif not self._knows(parse_qs(address.query).get("token", [""])[0]):
            self._say(
                HTTPStatus.FORBIDDEN, "open the address that 'mascarin explore' printed, with its token"
            )
        else:
            self._send(HTTPStatus.OK, "text/html; charset=utf-8", self._server.html)

    def do_POST(self) -> None:
        """Answer a request of the page."""
        length = self.headers.get("Content-Length", "")
        if not length.isdecimal() or len(length) > len(str(_MAX_BODY)) or int(length) > _MAX_BODY:
            self.close_connection = True
            self._say(HTTPStatus.REQUEST_ENTITY_TOO_LARGE, f"a request has at most {_MAX_BODY} bytes")
            return
        body = self.rfile.read(int(length))
        if not self._is_own_host():
            return
        if not self._knows(self.headers.get(TOKEN, "")):
            self._say(HTTPStatus.FORBIDDEN, "the request does not have the token of this page")
            return
        answer = self._server.answers.get(self.path)
        if answer is None:
            self._say(HTTPStatus.NOT_FOUND, "there is nothing here")
            return
        try:
            content = json.loads(body)
        except (ValueError, RecursionError):
            self._say(HTTPStatus.BAD_REQUEST, "the request is no JSON")
            return
        try:
            if not isinstance(content, dict):
                raise InputError("request: expected an object")
            reply = answer(content)
        except (MascarinError, OSError) as error:
            self._json(HTTPStatus.OK, {"refused": str(error)})  # an answer: browsers log failures
        except Exception as error:  # whatever is wrong is said on the page, and the server goes on
            text = f"a defect in Mascarin: {type(error).__name__}: {error}"
            sys.stderr.write(f"error: {text}\n")
            self._say(HTTPStatus.INTERNAL_SERVER_ERROR, text)
        else:
            self._json(HTTPStatus.OK, reply)

    def _is_own_host(self) -> bool:
        """Whether the request names this server, and comes from its page if it says where it comes from."""
        names = {f"{name}:{self._server.server_port}" for name in (HOST, "localhost")}
        origin = self.headers.get("Origin")
        matches = self.headers.get("Host", "") in names and (
            origin is None or origin in {f"http://{name}" for name in names}
        )
        if not matches:
            self._say(HTTPStatus.FORBIDDEN, "this server answers only to its own address")
        return matches

    def _knows(self, token: str) -> bool:
        return secrets.compare_digest(token.encode(), self._server.token.encode())

    def _say(self, status: HTTPStatus, words: str) -> None:
        self._json(status, {"error": words})

    def _json(self, status: HTTPStatus, content: Mapping[str, Any]) -> None:
        self._send(status, "application/json", json.dumps(content, separators=(",", ":")).encode())

    def _send(self, status: HTTPStatus, kind: str, body: bytes) -> None:
        self.send_response(status)
        for name, value in {**_HEADERS, "Content-Type": kind, "Content-Length": str(len(body))}.items():
            self.send_header(name, value)
        self.end_headers()
        self.wfile.write(body)

    def log_message(self, format: str, *args: Any) -> None:
        """Print nothing."""
