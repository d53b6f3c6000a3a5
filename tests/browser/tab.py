"""A tab of a browser: opens files, is looked at as pixels, and does what a hand does."""

import base64
import io
import json
from pathlib import Path
from typing import Any

import numpy as np
from bidi import Bidi
from numpy.typing import NDArray
from PIL import Image

Pixels = NDArray[np.uint8]
WIDE, NARROW = (1400, 900), (390, 800)
KEYS = {"ArrowLeft": "\ue012", "ArrowUp": "\ue013", "ArrowRight": "\ue014", "ArrowDown": "\ue015"}
KEYS |= {"Home": "\ue011", "End": "\ue010", "Enter": "\ue007", "Tab": "\ue004", "Escape": "\ue00c"}
#: run before any script of a page: what the page is refused, or fails in, is kept
WATCH = """() => {
  window.faults = [];
  const add = (text) => window.faults.push(text);
  addEventListener("error", (event) => add(`error: ${event.message}`), true);
  addEventListener("unhandledrejection", (event) => add(`rejection: ${event.reason}`));
  addEventListener("securitypolicyviolation", (event) =>
    add(`refused: ${event.violatedDirective} ${event.blockedURI} ${event.sample}`));
}"""
NO_WEBGL = """() => {
  const get = HTMLCanvasElement.prototype.getContext;
  HTMLCanvasElement.prototype.getContext = function (kind, ...more) {
    return /webgl/.test(kind) ? null : get.call(this, kind, ...more);
  };
}"""
CALM = """() => {
  const ask = window.matchMedia.bind(window);
  window.matchMedia = (query) =>
    ask(/prefers-reduced-motion: *reduce/.test(query) ? "all" : query);
}"""
READY = """new Promise((done, fail) => {
  const look = (tries) => {
    if (document.documentElement.dataset.ready !== undefined) return done("ready");
    if (tries > 1500) return fail(new Error(document.body.innerText.slice(0, 500)));
    setTimeout(look, 20, tries + 1);
  };
  look(0);
})"""
#: frames are drawn when they are asked for: after three all that was asked for is there
FRAMES = """new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(() =>
  requestAnimationFrame(() => done(0)))))"""


def number(text: str) -> float:
    """Return a number as pages write it, with a minus sign that is one."""
    return float(text.replace("\N{MINUS SIGN}", "-"))


class Tab:
    """One tab; a page opened in it is watched for errors and requests."""

    def __init__(self, name: str, bidi: Bidi) -> None:
        self.name, self.bidi = name, bidi
        bidi.call("session.subscribe", {"events": ["log.entryAdded", "network.beforeRequestSent"]})
        self.context = bidi.call("browsingContext.getTree")["contexts"][0]["context"]
        bidi.call("script.addPreloadScript", {"functionDeclaration": WATCH})
        self.at: tuple[float, float] = (0, 0)

    def open(
        self,
        path: Path,
        size: tuple[int, int] = WIDE,
        *,
        dots: float = 1,
        webgl: bool = True,
        calm: bool = False,
        ready: str = READY,
    ) -> None:
        """Open a file in a window of a size (pixels), with `dots` of the screen a pixel.

        `calm` is who wants nothing to move by itself.
        """
        shape = {"viewport": dict(zip(("width", "height"), size, strict=True))}
        given = {"context": self.context, **shape, "devicePixelRatio": dots}
        self.bidi.call("browsingContext.setViewport", given)
        stubs = [
            self.bidi.call("script.addPreloadScript", {"functionDeclaration": text})
            for text, wanted in ((NO_WEBGL, not webgl), (CALM, calm))
            if wanted
        ]
        self.bidi.events.clear()
        self.hand([{"type": "pointerMove", "x": 0, "y": 0}])
        self.at = (0, 0)
        place = {"context": self.context, "url": path.as_uri(), "wait": "complete"}
        self.bidi.call("browsingContext.navigate", place)
        for stub in stubs:
            self.bidi.call("script.removePreloadScript", {"script": stub["script"]})
        self.run(ready)
        self.settle()

    def run(self, expression: str) -> Any:
        """Return what an expression of JavaScript gives, or its promise, by JSON."""
        text = f"Promise.resolve({expression}).then((found) => JSON.stringify(found ?? null))"
        given = {"expression": text, "target": {"context": self.context}, "awaitPromise": True}
        told = self.bidi.call("script.evaluate", given)
        assert told["type"] == "success", told["exceptionDetails"]["text"]
        return json.loads(told["result"]["value"])

    def settle(self) -> None:
        self.run(FRAMES)

    def faults(self) -> list[str]:
        """Return errors and warnings, what the policy refused, and requests but for the page."""
        found: list[str] = self.run("window.faults")
        page = self.run("location.href")
        for event, told in self.bidi.events:
            if event == "log.entryAdded" and told["level"] in ("error", "warn"):
                found.append(f"{told['level']}: {told['text']}")
            if event == "network.beforeRequestSent" and told["request"]["url"] != page:
                found.append(f"request: {told['request']['url']}")
        return found

    def text(self, selector: str) -> str:
        found: str = self.run(f"document.querySelector({json.dumps(selector)}).innerText")
        return found

    def box(self, selector: str) -> tuple[float, float, float, float]:
        """Return left, top, width and height (pixels of the window) of an element, scrolled to."""
        element = f"document.querySelector({json.dumps(selector)})"
        self.run(f'{element}.scrollIntoView({{block: "nearest"}})')
        self.settle()
        x, y, w, h = self.run(
            f"(({{x, y, width, height}}) => [x, y, width, height])({element}"
            ".getBoundingClientRect())"
        )
        return x, y, w, h

    def pixels(self, box: tuple[float, float, float, float] | None = None) -> Pixels:
        """Return what is seen, (rows, columns, 3), of a box or of the window."""
        self.settle()
        given: dict[str, Any] = {"context": self.context}
        if box:
            clip = dict(zip(("x", "y", "width", "height"), box, strict=True))
            given["clip"] = {"type": "box", **clip}
        data = self.bidi.call("browsingContext.captureScreenshot", given)["data"]
        return np.asarray(Image.open(io.BytesIO(base64.b64decode(data))).convert("RGB"))

    # What a hand does.

    def hand(self, actions: list[dict[str, Any]]) -> None:
        source = {"type": "pointer", "id": "mouse", "parameters": {"pointerType": "mouse"}}
        given = {"context": self.context, "actions": [{**source, "actions": actions}]}
        self.bidi.call("input.performActions", given)

    def move(self, x: float, y: float) -> None:
        self.at = (x, y)
        self.hand([{"type": "pointerMove", "x": round(x), "y": round(y)}])
        self.settle()

    def click(self, x: float, y: float, times: int = 1) -> None:
        press = [{"type": "pointerDown", "button": 0}, {"type": "pointerUp", "button": 0}]
        self.hand([{"type": "pointerMove", "x": round(x), "y": round(y)}, *(times * press)])
        self.settle()

    def press(self, selector: str) -> None:
        """Click the middle of an element."""
        x, y, w, h = self.box(selector)
        self.click(x + w / 2, y + h / 2)

    def drag(self, *places: tuple[float, float]) -> None:
        """Move with the button down along places."""
        steps = [{"type": "pointerMove", "x": round(x), "y": round(y)} for x, y in places]
        down, up = ({"type": name, "button": 0} for name in ("pointerDown", "pointerUp"))
        self.hand([steps[0], down, *steps[1:], up])
        self.settle()

    def pinch(self, *ways: list[tuple[float, float]]) -> None:
        """Move fingers, each along places, down from the first to the last."""
        sources = []
        for k, way in enumerate(ways):
            steps = [{"type": "pointerMove", "x": round(x), "y": round(y)} for x, y in way]
            down, up = ({"type": name, "button": 0} for name in ("pointerDown", "pointerUp"))
            finger = {"type": "pointer", "id": f"finger{k}", "parameters": {"pointerType": "touch"}}
            sources.append({**finger, "actions": [steps[0], down, *steps[1:], up]})
        given = {"context": self.context, "actions": sources}
        self.bidi.call("input.performActions", given)
        self.settle()

    def wheel(self, x: float, y: float, pixels: int) -> None:
        turn = {"type": "scroll", "x": round(x), "y": round(y), "deltaX": 0, "deltaY": pixels}
        source = {"type": "wheel", "id": "wheel", "actions": [turn]}
        given = {"context": self.context, "actions": [source]}
        self.bidi.call("input.performActions", given)
        self.settle()

    def keys(self, *names: str) -> None:
        strokes = [
            {"type": kind, "value": KEYS.get(name, name)}
            for name in names
            for kind in ("keyDown", "keyUp")
        ]
        source = {"type": "key", "id": "keys", "actions": strokes}
        given = {"context": self.context, "actions": [source]}
        self.bidi.call("input.performActions", given)
        self.settle()

    def focus(self, selector: str) -> None:
        self.run(f"document.querySelector({json.dumps(selector)}).focus()")
