"""Chromium without a window, driven through a pipe: pages are opened, scripts run in them.

The protocol is that of the developer tools: JSON, each message ended by a zero byte.
"""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import time
from pathlib import Path
from typing import Any

BROWSERS = ("chromium", "chromium-browser", "google-chrome")
BROWSER = next(filter(None, map(shutil.which, BROWSERS)), "")
WANTED = os.environ.get("RIBBONOPT_BROWSERS") == "on"  # a missing one is a failure
OPTIONS = ("--headless=new", "--no-sandbox", "--hide-scrollbars", "--disable-dev-shm-usage")
WEBGL = ("--use-angle=swiftshader", "--enable-unsafe-swiftshader")
NO_WEBGL = ("--disable-gpu", "--disable-3d-apis")
WAIT = 120.0  # seconds until a page is taken to hang


class Browser:
    """One process with one page; `said` has what the console was told and what was asked for."""

    def __init__(
        self, profile: Path, size: tuple[int, int] = (1000, 700), *more: str, dark: bool = False
    ) -> None:
        (out, self._write), (self._read, into) = os.pipe(), os.pipe()
        command = [BROWSER, *OPTIONS, *(more or WEBGL), f"--user-data-dir={profile}"]
        command += [f"--window-size={size[0]},{size[1]}", "--remote-debugging-pipe", "about:blank"]
        # It reads messages from 3 and writes them to 4.
        shell = ["bash", "-c", f'exec "$@" 3<&{out} 4>&{into}', "bash", *command]
        quiet = subprocess.DEVNULL
        self._process = subprocess.Popen(shell, pass_fds=(out, into), stdout=quiet, stderr=quiet)
        os.close(out)
        os.close(into)
        self._number, self._rest, self._session = 0, b"", ""
        self.said: list[str] = []
        pages = self.call("Target.getTargets")["targetInfos"]
        page = next(one["targetId"] for one in pages if one["type"] == "page")
        found = self.call("Target.attachToTarget", targetId=page, flatten=True)
        self._session = found["sessionId"]
        for domain in ("Page", "Runtime", "Log", "Network"):
            self.call(f"{domain}.enable")
        scheme = {"name": "prefers-color-scheme", "value": "dark" if dark else "light"}
        self.call("Emulation.setEmulatedMedia", features=[scheme])

    def __enter__(self) -> Browser:
        return self

    def __exit__(self, *_: object) -> None:
        self._process.terminate()
        self._process.wait()
        os.close(self._read)
        os.close(self._write)

    def call(self, method: str, **parameters: Any) -> dict[str, Any]:
        """Return what a method of the protocol answers."""
        self._number += 1
        message = {"id": self._number, "method": method, "params": parameters}
        message |= {"sessionId": self._session} if self._session else {}
        os.write(self._write, json.dumps(message).encode() + b"\0")
        while True:
            found = self._next()
            if found.get("id") == self._number:
                assert "error" not in found, found
                result: dict[str, Any] = found["result"]
                return result
            self._note(found.get("method", ""), found.get("params", {}))

    def open(self, page: Path, ready: str = "document.readyState === 'complete'") -> None:
        """Open a page and wait until an expression is true."""
        self.call("Page.navigate", url=page.as_uri())
        self.wait(f"document.documentElement && {ready}")

    def wait(self, expression: str) -> None:
        """Wait until an expression is true."""
        end = time.monotonic() + WAIT
        while not self.run(expression):
            assert time.monotonic() < end, f"never true: {expression}; {self.said}"
            time.sleep(0.02)

    def run(self, expression: str) -> Any:
        """Return the value of an expression, or of the promise that it is."""
        asked = {"expression": expression, "returnByValue": True, "awaitPromise": True}
        found = self.call("Runtime.evaluate", **asked)
        assert "exceptionDetails" not in found, found["exceptionDetails"]
        return found["result"].get("value")

    def _next(self) -> dict[str, Any]:
        while b"\0" not in self._rest:
            part = os.read(self._read, 1 << 16)
            assert part, "the browser has ended"
            self._rest += part
        message, self._rest = self._rest.split(b"\0", 1)
        found: dict[str, Any] = json.loads(message)
        return found

    def _note(self, method: str, told: dict[str, Any]) -> None:
        if method == "Runtime.exceptionThrown":
            self.said.append(json.dumps(told["exceptionDetails"]))
        elif method == "Runtime.consoleAPICalled":
            self.said.append(json.dumps(told["args"]))
        elif method == "Log.entryAdded":
            self.said.append(told["entry"]["text"])
        elif method == "Network.requestWillBeSent":
            url = told["request"]["url"]
            if not url.startswith(("file:", "about:")):
                self.said.append(f"request for {url[:200]}")
