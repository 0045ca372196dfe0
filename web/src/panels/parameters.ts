// The chief numbers of the design, with sliders; each change is one of the page's changes to the design's text.

import { button, freshId, h, select } from '../widgets/dom'
import { field, parsed } from '../widgets/format'
import { page, store } from '../state/store'
import type { Parameter } from '../state/answers'

export function change(key: string, value: unknown): void {
  const changes = { ...page.changes }
  if (value === undefined) delete changes[key]
  else changes[key] = value
  store.set({ changes })
}

/** Slider position 0 to 1 to value and back: a factor of ten each way, or a stretch about the original. */
function scaleOf(chief: Parameter): { at(value: number): number; value(at: number): number } {
  const { original, size } = chief
  if (chief.logarithmic && original > 0) {
    const low = original / 10
    return { at: (v) => Math.log(v / low) / Math.log(100), value: (t) => Number((low * 100 ** t).toPrecision(4)) }
  }
  const low = chief.logarithmic ? 0 : original - size
  const span = chief.logarithmic ? 1 : 2 * size
  return { at: (v) => (v - low) / span, value: (t) => Number((low + t * span).toPrecision(4)) }
}

class NumberRow {
  readonly element: HTMLElement
  private readonly slider = h('input', { type: 'range', min: 0, max: 1, step: 'any' })
  private readonly number: HTMLInputElement
  private readonly undo: HTMLButtonElement
  private readonly wrong = h('p', { class: 'wrong', role: 'alert', hidden: true })
  private typing = false // a number that is being typed stays, whatever is answered meanwhile

  constructor(private chief: Parameter) {
    const id = freshId('number')
    this.number = h('input', {
      type: 'text',
      inputmode: 'decimal',
      id,
      class: 'number',
      autocomplete: 'off',
      'data-key': chief.key,
    })
    this.undo = button('↺', () => change(chief.key, undefined), {
      class: 'icon',
      'aria-label': `Reset ${chief.label}`,
      title: 'Back to the design',
    })
    this.slider.setAttribute('aria-label', `${chief.label} slider`)
    this.slider.addEventListener('input', () => change(chief.key, scaleOf(this.chief).value(Number(this.slider.value))))
    const put = () => {
      this.typing = false
      const value = parsed(this.number.value)
      if (Number.isNaN(value)) this.fail(`${this.number.value || 'nothing'} is not a number.`)
      else if (value !== this.current()) change(chief.key, value)
    }
    this.number.addEventListener('input', () => (this.typing = true))
    this.number.addEventListener('change', put)
    this.element = h(
      'div',
      { class: 'row wide' },
      h('label', { for: id }, chief.label, h('span', { class: 'unit' }, ` ${chief.unit}`)),
      this.slider,
      this.number,
      this.undo,
      this.wrong,
    )
    this.show(chief)
  }

  private current(): number {
    const changed = page.changes[this.chief.key]
    return typeof changed === 'number' ? changed : this.chief.value
  }

  fail(message: string): void {
    this.wrong.textContent = message
    this.wrong.hidden = message === ''
    this.number.setAttribute('aria-invalid', String(message !== ''))
  }

  show(chief: Parameter): void {
    this.chief = chief
    const value = this.current()
    this.slider.value = String(scaleOf(chief).at(value))
    if (!this.typing && (document.activeElement !== this.number || parsed(this.number.value) !== value))
      this.number.value = field(Number(value.toPrecision(6)))
    this.undo.style.visibility = chief.key in page.changes ? 'visible' : 'hidden'
    this.fail('')
  }
}

export interface NumbersPanel {
  element: HTMLElement
  fail(key: string, message: string): boolean
}

export function numbersPanel(): NumbersPanel {
  const list = h('div')
  const rows = new Map<string, NumberRow>()
  const joints = select(
    'Joint model',
    [
      ['universal', 'Universal joints (exact)'],
      ['spin_free', 'Spin-free legs (the paper)'],
    ] as const,
    page.joint,
    (joint) => store.set({ joint }),
  )
  const show = () => {
    for (const chief of page.design?.parameters ?? []) {
      const row = rows.get(chief.key)
      if (row) row.show(chief)
      else {
        const made = new NumberRow(chief)
        rows.set(chief.key, made)
        list.append(made.element)
      }
    }
  }
  store.on(['design', 'changes'], show)
  store.on(['joint'], () => joints.set(page.joint))
  const reset = button('Reset', () => store.set({ changes: {} }), {
    class: 'quiet',
    title: 'Undo all changes to the design',
  })
  store.on(['changes'], () => (reset.disabled = Object.keys(page.changes).length === 0))
  return {
    element: h(
      'section',
      { 'aria-labelledby': 'numbers-title', class: 'block' },
      h('div', { class: 'bar' }, h('h2', { id: 'numbers-title' }, 'Machine'), h('span', { class: 'spring' }), reset),
      list,
      h('div', { class: 'row single' }, joints.element),
    ),
    fail(key, message) {
      const row = rows.get(key)
      row?.fail(message)
      return row !== undefined
    },
  }
}
