"""A cell of a notebook without a notebook: a page that shows widgets as anywidget does, and the kernel behind it, here.

The module is imported from its text, and models have what anywidget gives them. What ipywidgets would send through its
comm goes to the page, and what the page saves goes to the widget.
"""

import json
from typing import Any

MODELS = """
class Model {
  constructor(name, state) {
    Object.assign(this, { name, state, changed: {}, listeners: {} })
  }
  get(key) { return this.state[key] }
  set(key, value) {
    if (JSON.stringify(value) === JSON.stringify(this.state[key])) return
    this.state[key] = value
    this.changed[key] = value
    this.tell([key])
  }
  save_changes() {
    const changes = this.changed
    this.changed = {}
    window.kernel?.(this.name, JSON.stringify(changes))
  }
  take(state) {
    const keys = Object.keys(state).filter((key) => JSON.stringify(state[key]) !== JSON.stringify(this.state[key]))
    Object.assign(this.state, state)
    this.tell(keys)
  }
  tell(keys) { for (const key of keys) for (const one of [...(this.listeners[`change:${key}`] ?? [])]) one() }
  on(event, listener) { (this.listeners[event] ??= []).push(listener) }
  off(event, listener) { this.listeners[event] = this.listeners[event].filter((one) => one !== listener) }
}
window.models = {}
window.cells = []
window.show = async (name, state, width) => {
  const model = (models[name] ??= new Model(name, state))
  const url = URL.createObjectURL(new Blob([state._esm], { type: 'text/javascript' }))
  const widget = await import(url)
  const el = document.createElement('div')
  el.style.width = width
  const leave = await widget.default.render({ model, el }) // a notebook puts it on the page afterwards
  document.body.append(el)
  cells.push({ el, leave })
}
"""


class Notebook:
    """A page with views, and the kernel that they talk to."""

    def __init__(self, page: Any, style: str = "", kernel: bool = True) -> None:
        self.page = page
        self.views: dict[str, Any] = {}
        page.set_content(f"<!doctype html><style>body {{ margin: 8px; {style} }}</style><body>")
        page.add_script_tag(content=MODELS)
        if kernel:
            page.expose_function("kernel", self._receive)

    def show(self, view: Any, width: str = "900px", name: str = "view") -> Any:
        """Show a view in a new cell, whose element is returned."""
        self.views[name] = view
        view.comm.send = lambda data, **more: self._send(name, data)
        state = {
            key: value for key, value in view.get_state().items() if isinstance(value, str | list | dict | int | None)
        }
        self.page.evaluate("([name, state, width]) => show(name, state, width)", [name, state, width])
        cell = self.page.locator("body > div").nth(self.page.locator("body > div").count() - 1)
        cell.locator("#frequency:not(:empty)").wait_for()
        return cell

    def _send(self, name: str, message: dict[str, Any]) -> None:
        """As ipywidgets sends it: only what JSON can hold."""
        state = json.loads(json.dumps(message.get("state", {}), allow_nan=False))
        if message["method"] == "update":
            self.page.evaluate("([name, state]) => models[name].take(state)", [name, state])

    def _receive(self, name: str, changes: str) -> None:
        self.views[name].set_state(json.loads(changes))
