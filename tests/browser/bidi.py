"""A thin client of WebDriver BiDi, which Chromium and Firefox both speak: calls and events."""

import json
from typing import Any

SECONDS = 60.0  # that an answer may take on a busy machine


class BrowserError(RuntimeError):
    """What a browser answers to a call that it cannot do."""


class Bidi:
    """A session: `call` waits for the answer, what is told meanwhile is in `events`."""

    def __init__(self, address: str) -> None:
        import websocket  # `browsers.require` has looked for it

        # Firefox refuses calls that say they come from a page.
        self._socket = websocket.create_connection(address, timeout=SECONDS, suppress_origin=True)
        self._count = 0
        self.events: list[tuple[str, dict[str, Any]]] = []

    def call(self, method: str, params: dict[str, Any] | None = None) -> dict[str, Any]:
        self._count += 1
        message = {"id": self._count, "method": method, "params": params or {}}
        self._socket.send(json.dumps(message))
        while True:
            told = json.loads(self._socket.recv())
            if told["type"] == "event":
                self.events.append((told["method"], told["params"]))
            elif told.get("id") == self._count:
                if told["type"] == "error":
                    raise BrowserError(f"{method}: {told['error']}: {told['message']}")
                result: dict[str, Any] = told["result"]
                return result

    def close(self) -> None:
        self._socket.close()
