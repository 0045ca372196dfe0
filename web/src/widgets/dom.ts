// Elements are built here; nowhere is HTML set from text.

export type Child = Node | string | number | null | undefined | false
export type Attributes = Record<string, unknown>

function fill(element: Element, attributes: Attributes, children: Child[]): void {
  for (const [name, value] of Object.entries(attributes)) {
    if (value === undefined || value === null || value === false) continue
    if (name.startsWith('on')) element.addEventListener(name.slice(2), value as EventListener)
    else if (name === 'value' && 'value' in element) (element as HTMLInputElement).value = String(value)
    else element.setAttribute(name, value === true ? '' : String(value))
  }
  for (const child of children)
    if (child !== null && child !== undefined && child !== false)
      element.append(child instanceof Node ? child : String(child))
}

export function h<K extends keyof HTMLElementTagNameMap>(
  tag: K,
  attributes: Attributes = {},
  ...children: Child[]
): HTMLElementTagNameMap[K] {
  const element = document.createElement(tag)
  fill(element, attributes, children)
  return element
}

export function svg<K extends keyof SVGElementTagNameMap>(
  tag: K,
  attributes: Attributes = {},
  ...children: Child[]
): SVGElementTagNameMap[K] {
  const element = document.createElementNS('http://www.w3.org/2000/svg', tag)
  fill(element, attributes, children)
  return element
}

let labels = 0
/** An id for a label and its control. */
export const freshId = (stem: string): string => `${stem}-${++labels}`

export interface Choice<T extends string> {
  element: HTMLSelectElement
  set(value: T): void
}

export function select<T extends string>(
  label: string,
  options: readonly (readonly [T, string])[],
  value: T,
  chosen: (value: T) => void,
): Choice<T> {
  const element = h(
    'select',
    { 'aria-label': label, title: label },
    ...options.map(([v, text]) => h('option', { value: v }, text)),
  )
  element.value = value
  element.addEventListener('change', () => chosen(element.value as T))
  return { element, set: (v) => (element.value = v) }
}

export function button(text: string, click: () => void, attributes: Attributes = {}): HTMLButtonElement {
  return h('button', { type: 'button', onclick: click, ...attributes }, text)
}

/** A line of text that screen readers speak when it changes. */
export function status(attributes: Attributes = {}): HTMLElement {
  return h('p', { role: 'status', 'aria-live': 'polite', ...attributes })
}

/** Calls `run` once, `ms` after the last call. */
export function settled(ms: number, run: () => void): () => void {
  let timer = 0
  return () => {
    clearTimeout(timer)
    timer = window.setTimeout(run, ms)
  }
}

const waiting = new Set<() => void>()

/** Calls `run` at most once per frame. */
export function perFrame(run: () => void): () => void {
  return () => {
    if (waiting.has(run)) return
    waiting.add(run)
    requestAnimationFrame(() => {
      if (waiting.delete(run)) run()
    })
  }
}

/** Run now what waits for the next frame. */
export function flushFrames(): void {
  for (const run of [...waiting]) {
    waiting.delete(run)
    run()
  }
}
