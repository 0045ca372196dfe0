// The six coordinates of a pose: a slider and a number each. Whoever holds the pose is told what a person wants.

import { COORDINATES, type PoseBox } from '../state/answers'
import { freshId, h } from '../widgets/dom'
import { fault } from '../widgets/fault'
import { field, parsed } from '../widgets/format'

/** The holder of the pose: m and degrees. */
export interface PoseHolder {
  pose(): number[]
  /** Ends of the sliders. */
  box(): PoseBox
  /** Unit of lengths on the screen. */
  unit(): 'mm' | 'm'
  put(pose: number[]): void
}

interface Row {
  element: HTMLElement
  show(): void
}

/** One coordinate of the pose that somebody holds. */
class Coordinate {
  readonly name: string

  constructor(
    private readonly holder: PoseHolder,
    private readonly i: number,
  ) {
    this.name = COORDINATES[i]
  }

  get value(): number {
    return this.holder.pose()[this.i]
  }

  set value(value: number) {
    const pose = [...this.holder.pose()]
    pose[this.i] = value
    this.holder.put(pose)
  }

  get ends(): [number, number] {
    const { low, high } = this.holder.box()
    return [low[this.i], high[this.i]]
  }

  get unit(): string {
    return this.i < 3 ? this.holder.unit() : '°'
  }

  /** Of the number on the screen. */
  get factor(): number {
    return this.unit === 'mm' ? 1000 : 1
  }

  /** A value with its unit, as the number has it. */
  text(value: number): string {
    return `${field(value * this.factor)} ${this.unit}`
  }
}

/** The slider of a coordinate, from end to end. */
function slider(at: Coordinate): HTMLInputElement {
  const element = h('input', { type: 'range', step: 'any', 'aria-label': `${at.name} slider`, tabindex: 0 })
  element.addEventListener('input', () => {
    const [low, high] = at.ends
    const steps = (high - low) / 1000
    const power = 10 ** Math.floor(Math.log10(steps || 1))
    at.value = Number((Math.round(Number(element.value) / power) * power).toPrecision(12))
  })
  element.addEventListener('keydown', (event) => {
    const way = { ArrowLeft: -1, ArrowDown: -1, ArrowRight: 1, ArrowUp: 1, PageDown: -10, PageUp: 10 }[event.key]
    if (!way) return
    event.preventDefault()
    const [low, high] = at.ends
    at.value = Math.min(Math.max(at.value + (way * (high - low)) / 200, low), high)
  })
  return element
}

/** The number of a coordinate, and what is wrong with it. */
function number(at: Coordinate): { input: HTMLInputElement; wrong: HTMLElement; show(): void } {
  const attributes = { class: 'number', autocomplete: 'off', spellcheck: 'false' }
  const input = h('input', { type: 'text', inputmode: 'decimal', id: freshId('pose'), ...attributes })
  const wrong = fault(input)
  let typing = false // answers do not replace a number that is being typed
  const put = () => {
    typing = false
    const value = parsed(input.value)
    if (Number.isFinite(value)) {
      at.value = value / at.factor
      return
    }
    const typed = input.value.trim() || 'empty'
    wrong.tell(`${at.name} is ${typed}; give a number of ${at.unit}. Shown: ${at.text(at.value)}.`)
  }
  input.addEventListener('input', () => {
    typing = true
  })
  input.addEventListener('change', put)
  input.addEventListener('keydown', (event) => {
    if (event.key === 'Enter') put()
  })
  const show = () => {
    const shown = field(at.value * at.factor)
    if (typing) return
    if (!input.matches(':focus') || parsed(input.value) !== parsed(shown)) input.value = shown
    wrong.tell('')
  }
  return { input, wrong: wrong.element, show }
}

function row(at: Coordinate): Row {
  const [range, { input, wrong, show }] = [slider(at), number(at)]
  const suffix = h('span', { class: 'unit' })
  const outside = h('span', { class: 'hint', hidden: true })
  const label = h('label', { for: input.id }, at.name)
  return {
    element: h('div', { class: 'row', 'data-part': 'pose' }, label, range, input, suffix, wrong, outside),
    show() {
      const [[low, high], value] = [at.ends, at.value]
      Object.assign(range, { min: String(low), max: String(high), value: String(value) })
      range.setAttribute('aria-valuetext', at.text(value))
      show()
      outside.hidden = value >= low - 1e-12 && value <= high + 1e-12
      outside.textContent = `outside the pose box: ${at.text(low)} to ${at.text(high)}`
      suffix.textContent = at.unit
    },
  }
}

/** The rows of all six, and what shows in them what their holder has. */
export function poseRows(holder: PoseHolder): { elements: HTMLElement[]; show(): void } {
  const rows = COORDINATES.map((_, i) => row(new Coordinate(holder, i)))
  return {
    elements: rows.map((one) => one.element),
    show() {
      for (const one of rows) one.show()
    },
  }
}
