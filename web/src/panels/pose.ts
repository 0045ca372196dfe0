// The six inputs of the pose. The page's state holds the pose; the inputs show and change it.

import { COORDINATES } from '../state/answers'
import { page, store } from '../state/store'
import { choose } from '../widgets/bound'
import { button, freshId, h } from '../widgets/dom'
import { fault } from '../widgets/fault'
import { field, parsed } from '../widgets/format'

const isLength = (i: number) => i < 3
const factor = (i: number) => (isLength(i) && page.unit === 'mm' ? 1000 : 1)
const unit = (i: number) => (isLength(i) ? page.unit : '°')
const UNITS = [
  ['mm', 'mm'],
  ['m', 'm'],
] as const

export function setPose(pose: number[]): void {
  store.set({ pose: [...pose] })
}

function setOne(i: number, value: number): void {
  const pose = [...page.pose]
  pose[i] = value
  store.set({ pose })
}

interface Row {
  element: HTMLElement
  show(): void
}

/** A coordinate with its unit, as the number has it. */
const text = (i: number, value: number) => `${field(value * factor(i))} ${unit(i)}`

/** The slider of a coordinate, from end to end of the pose box. */
function slider(i: number): HTMLInputElement {
  const element = h('input', { type: 'range', step: 'any', 'aria-label': `${COORDINATES[i]} slider`, tabindex: 0 })
  element.addEventListener('input', () => {
    const [low, high] = [page.box.low[i], page.box.high[i]]
    const steps = (high - low) / 1000
    const power = 10 ** Math.floor(Math.log10(steps || 1))
    setOne(i, Number((Math.round(Number(element.value) / power) * power).toPrecision(12)))
  })
  element.addEventListener('keydown', (event) => {
    const way = { ArrowLeft: -1, ArrowDown: -1, ArrowRight: 1, ArrowUp: 1, PageDown: -10, PageUp: 10 }[event.key]
    if (!way) return
    event.preventDefault()
    const step = (page.box.high[i] - page.box.low[i]) / 200
    setOne(i, Math.min(Math.max(page.pose[i] + way * step, page.box.low[i]), page.box.high[i]))
  })
  return element
}

/** The number of a coordinate, and what is wrong with it. */
function number(i: number): { input: HTMLInputElement; wrong: HTMLElement; show(): void } {
  const attributes = { class: 'number', autocomplete: 'off', spellcheck: 'false' }
  const input = h('input', { type: 'text', inputmode: 'decimal', id: freshId('pose'), ...attributes })
  const wrong = fault(input)
  let typing = false // answers do not replace a number that is being typed
  const put = () => {
    typing = false
    const value = parsed(input.value)
    if (Number.isFinite(value)) return setOne(i, value / factor(i))
    const typed = input.value.trim() || 'empty'
    wrong.tell(`${COORDINATES[i]} is ${typed}; give a number of ${unit(i)}. Shown: ${text(i, page.pose[i])}.`)
  }
  input.addEventListener('input', () => {
    typing = true
  })
  input.addEventListener('change', put)
  input.addEventListener('keydown', (event) => {
    if (event.key === 'Enter') put()
  })
  const show = () => {
    const shown = field(page.pose[i] * factor(i))
    if (typing) return
    if (document.activeElement !== input || parsed(input.value) !== parsed(shown)) input.value = shown
    wrong.tell('')
  }
  return { input, wrong: wrong.element, show }
}

function row(i: number): Row {
  const [range, { input, wrong, show }] = [slider(i), number(i)]
  const suffix = h('span', { class: 'unit' })
  const outside = h('span', { class: 'hint', hidden: true })
  const label = h('label', { for: input.id }, COORDINATES[i])
  return {
    element: h('div', { class: 'row', 'data-part': 'pose' }, label, range, input, suffix, wrong, outside),
    show() {
      const [low, high, at] = [page.box.low[i], page.box.high[i], page.pose[i]]
      Object.assign(range, { min: String(low), max: String(high), value: String(at) })
      range.setAttribute('aria-valuetext', text(i, at))
      show()
      outside.hidden = at >= low - 1e-12 && at <= high + 1e-12
      outside.textContent = `outside the pose box: ${text(i, low)} to ${text(i, high)}`
      suffix.textContent = unit(i)
    },
  }
}

export function posePanel(): HTMLElement {
  const rows = COORDINATES.map((_, i) => row(i))
  const show = () => {
    for (const row of rows) row.show()
  }
  const units = choose('unit', 'Unit of lengths', UNITS)
  const home = button('Home', () => page.design && setPose(page.design.home), {
    title: 'Move to the home pose (H)',
    class: 'quiet',
  })
  store.on(['pose', 'unit', 'box', 'design'], () => {
    show()
  })
  return h(
    'section',
    { 'aria-labelledby': 'pose-title', class: 'block' },
    h('div', { class: 'bar' }, h('h2', { id: 'pose-title' }, 'Pose'), h('span', { class: 'spring' }), home, units),
    ...rows.map((r) => r.element),
  )
}
