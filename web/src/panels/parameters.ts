// The main parameters of the design, with sliders. A change is kept beside the design's text.

import type { Parameter } from '../state/answers'
import { page, store } from '../state/store'
import { choose } from '../widgets/bound'
import { button, freshId, h } from '../widgets/dom'
import { type Fault, fault } from '../widgets/fault'
import { field, parsed } from '../widgets/format'
import { spring } from '../widgets/layout'

/** Change a key of the design; undefined undoes the change. */
export function change(key: string, value: unknown): void {
  const changes = { ...page.changes }
  if (value === undefined) delete changes[key]
  else changes[key] = value
  store.set({ changes })
}

/** From value to slider position (0 to 1) and back: a factor of ten each way, or linear about the original value. */
function scaleOf(parameter: Parameter): { at(value: number): number; value(at: number): number } {
  const { original, size } = parameter
  if (parameter.logarithmic && original > 0) {
    const low = original / 10
    return { at: (v) => Math.log(v / low) / Math.log(100), value: (t) => Number((low * 100 ** t).toPrecision(4)) }
  }
  const low = parameter.logarithmic ? 0 : original - size
  const span = parameter.logarithmic ? 1 : 2 * size
  return { at: (v) => (v - low) / span, value: (t) => Number((low + t * span).toPrecision(4)) }
}

class ParameterRow {
  readonly element: HTMLElement
  private readonly slider = h('input', { type: 'range', min: 0, max: 1, step: 'any' })
  private readonly number: HTMLInputElement
  private readonly undo: HTMLButtonElement
  private readonly wrong: Fault
  private typing = false // answers do not replace a number that is being typed

  constructor(private parameter: Parameter) {
    const { key, label, unit } = parameter
    const id = freshId('number')
    const attributes = { class: 'number', autocomplete: 'off', 'data-key': key }
    this.number = h('input', { type: 'text', inputmode: 'decimal', id, ...attributes })
    const resets = { class: 'icon', 'aria-label': `Reset ${label}`, title: 'Back to the design' }
    this.wrong = fault(this.number)
    this.undo = button('↺', () => change(key, undefined), resets)
    this.slider.setAttribute('aria-label', `${label} slider`)
    this.slider.addEventListener('input', () => {
      change(key, scaleOf(this.parameter).value(Number(this.slider.value)))
    })
    this.number.addEventListener('input', () => {
      this.typing = true
    })
    this.number.addEventListener('change', () => this.put())
    const name = h('label', { for: id }, label, h('span', { class: 'unit' }, ` ${unit}`))
    this.element = h(
      'div',
      { class: 'row wide', 'data-part': 'changes' },
      name,
      this.slider,
      this.number,
      this.undo,
      this.wrong.element,
    )
    this.show(parameter)
  }

  private get current(): number {
    const changed = page.changes[this.parameter.key]
    return typeof changed === 'number' ? changed : this.parameter.value
  }

  private put(): void {
    this.typing = false
    const value = parsed(this.number.value)
    if (Number.isNaN(value)) this.fail(`${this.number.value || 'nothing'} is not a number.`)
    else if (value !== this.current) change(this.parameter.key, value)
  }

  fail(message: string): void {
    this.wrong.tell(message)
  }

  show(parameter: Parameter): void {
    this.parameter = parameter
    const value = this.current
    this.slider.value = String(scaleOf(parameter).at(value))
    const meant = document.activeElement === this.number && parsed(this.number.value) === value
    if (!this.typing && !meant) this.number.value = field(Number(value.toPrecision(6)))
    this.undo.style.visibility = parameter.key in page.changes ? 'visible' : 'hidden'
    this.fail('')
  }
}

const JOINTS = [
  ['universal', 'Universal joints (exact)'],
  ['spin_free', 'Spin-free legs (the paper)'],
] as const

export interface ParametersPanel {
  element: HTMLElement
  fail(key: string, message: string): void
}

export function parametersPanel(): ParametersPanel {
  const list = h('div')
  const rows = new Map<string, ParameterRow>()
  const add = (parameter: Parameter) => {
    const row = new ParameterRow(parameter)
    rows.set(parameter.key, row)
    list.append(row.element)
  }
  store.on(['design', 'changes'], () => {
    const known = new Set(page.design?.parameters.map(({ key }) => key)) // legs with a law have no one stiffness
    for (const [key, row] of rows) row.element.hidden = !known.has(key)
    for (const parameter of page.design?.parameters ?? []) {
      const row = rows.get(parameter.key)
      if (row) row.show(parameter)
      else add(parameter)
    }
  })
  const undo = { class: 'quiet', title: 'Undo all changes to the design' }
  const reset = button('Reset', () => store.set({ changes: {} }), undo)
  store.on(['changes'], () => {
    reset.disabled = Object.keys(page.changes).length === 0
  })
  const title = h('div', { class: 'bar' }, h('h2', { id: 'numbers-title' }, 'Machine'), spring(), reset)
  const joint = h('div', { class: 'row single' }, choose('joint', 'Joint model', JOINTS))
  return {
    element: h('section', { 'aria-labelledby': 'numbers-title', class: 'block' }, title, list, joint),
    fail: (key, message) => rows.get(key)?.fail(message),
  }
}
