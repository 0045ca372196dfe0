// One field of the design's form: its numbers, one for all legs or one for each, and what is wrong with them.

import type { Field } from '../state/answers'
import { page, store } from '../state/store'
import { include } from '../widgets/bound'
import { button, freshId, h } from '../widgets/dom'
import { field, parsed } from '../widgets/format'
import { spring } from '../widgets/layout'
import { allEqual, flat, type Nested, put, shaped } from './nested'
import { change } from './parameters'

const ANY = -1 // in a shape: any length
const EACH = { class: 'quiet each', 'aria-pressed': 'false', 'data-option': 'each' }

type Write = (path: number[], text: string) => void

export class FieldRow {
  readonly element: HTMLElement
  private readonly cells = h('div', { class: 'cells' })
  private readonly wrong = h('p', { class: 'wrong', role: 'alert', hidden: true, id: freshId('wrong') })
  private value: Nested | undefined

  constructor(private readonly rule: Field) {
    const name = rule.key
      .replace(/^\w+\./, '')
      .replace(/_deg$/, '')
      .replace(/[._]/g, ' ')
    const perLeg = this.perLeg && !rule.shapes.every((shape) => shape.includes(ANY))
    const each = button('Each leg', () => include('each', rule.key, !this.each), EACH)
    store.on(['each'], () => {
      if (each.getAttribute('aria-pressed') === String(this.each)) return
      each.setAttribute('aria-pressed', String(this.each))
      this.draw()
    })
    const [unit, meaning] = [h('span', { class: 'unit' }, rule.unit), h('span', { class: 'meaning' }, rule.meaning)]
    const bar = h('div', { class: 'bar' }, h('strong', {}, name), unit, meaning, spring(), perLeg && each)
    this.element = h('div', { class: 'field-row', 'data-key': rule.key }, bar, this.cells, this.wrong)
  }

  /** Whether the legs may have different numbers. */
  private get perLeg(): boolean {
    const { key, shapes } = this.rule
    return shapes.length > 1 && !key.startsWith('suspension.')
  }

  private get each(): boolean {
    return page.each.includes(this.rule.key)
  }

  fail(message: string): void {
    this.wrong.textContent = message
    this.wrong.hidden = !message
    for (const cell of this.cells.querySelectorAll('input')) {
      cell.setAttribute('aria-invalid', String(message !== ''))
      if (message) cell.setAttribute('aria-describedby', this.wrong.id)
    }
  }

  /** Show a value, where the legs have this law. */
  show(value: Nested | undefined, law: string): void {
    this.fail('')
    const { key, laws } = this.rule
    this.element.hidden = laws.length ? !laws.includes(law) : key === 'legs.stiffness' && value === undefined
    if (JSON.stringify(value) === JSON.stringify(this.value) && this.cells.childElementCount) return
    this.value = value
    if (!this.cells.contains(document.activeElement)) this.draw()
  }

  private draw(): void {
    if (this.takesList) {
      this.cells.replaceChildren(this.list(this.value as number[] | number[][] | undefined))
      return
    }
    const value = shaped(this.value, this.perLeg ? this.rule.shapes : this.rule.shapes.slice(0, 1), this.each)
    let whole = structuredClone(value) // numbers in the cells; NaN where one is missing
    const write = (path: number[], text: string) => {
      whole = put(whole, path, parsed(text))
      const missing = flat(whole).filter(Number.isNaN).length
      if (this.rule.optional && missing === flat(whole).length) change(this.rule.key, null)
      else if (missing) this.fail(text.trim() ? `“${text}” is not a number.` : 'Fill in all the numbers of this field.')
      else change(this.rule.key, structuredClone(whole))
    }
    this.cells.replaceChildren(grid(value, (v, path) => input(this.rule, v, path, write)))
  }

  /** Whether the numbers are a row of any length, the same for all legs where it is theirs. */
  private get takesList(): boolean {
    const rows = Array.isArray(this.value) && Array.isArray(this.value[0]) ? this.value : []
    return this.rule.shapes.some((shape) => shape.includes(ANY)) && allEqual(rows) && !this.each
  }

  private list(value: number[] | number[][] | undefined): HTMLInputElement {
    const row = (Array.isArray(value?.[0]) ? value[0] : (value ?? [])) as number[]
    const element = h('input', {
      type: 'text',
      class: 'number list',
      value: row.map((v) => field(Number(v.toPrecision(9)))).join('; '),
      'aria-label': `${this.rule.key} ${this.rule.unit}, separated by semicolons`,
      placeholder: this.rule.optional ? 'none' : '',
      title: 'Numbers, separated by semicolons',
    })
    element.addEventListener('change', () => this.write(element.value))
    return element
  }

  private write(text: string): void {
    const words = text.split(/[;\s]+/).filter(Boolean)
    const wrong = words.find((word) => Number.isNaN(parsed(word)))
    if (wrong !== undefined) this.fail(`“${wrong}” is not a number.`)
    else if (words.length || this.rule.optional) change(this.rule.key, words.length ? words.map(parsed) : null)
    else this.fail('Give at least one number.')
  }
}

function input(rule: Field, value: number, path: number[], write: Write): HTMLInputElement {
  const place = path.map((i) => `[${i}]`).join('')
  const element = h('input', {
    type: 'text',
    class: 'number',
    inputmode: 'decimal',
    value: Number.isNaN(value) ? '' : field(Number(value.toPrecision(9))),
    'aria-label': `${rule.key}${place} ${rule.unit}`,
    placeholder: rule.optional ? 'none' : '',
  })
  element.addEventListener('change', () => write(path, element.value))
  return element
}

/** Cells for a number, a list or a matrix; those of a list of matrices one below the other. */
function grid(value: Nested, cell: (value: number, path: number[]) => HTMLElement): HTMLElement {
  const line = (values: Nested, path: number[]) => {
    const numbers = Array.isArray(values) ? (values as number[]) : [values]
    const at = (i: number) => (Array.isArray(values) ? [...path, i] : path)
    return h('div', { class: 'line' }, ...numbers.map((v, i) => cell(v, at(i))))
  }
  if (!isList(value) || !isList(value[0])) return line(value, [])
  if (!isList(value[0][0])) return h('div', { class: 'matrix' }, ...value.map((row, i) => line(row, [i])))
  const matrices = (value as Nested[][]).map((matrix, k) => {
    const name = h('span', { class: 'hint' }, `leg ${k + 1}`)
    return h('div', { class: 'matrix' }, name, ...matrix.map((row, i) => line(row, [k, i])))
  })
  return h('div', { class: 'matrices' }, ...matrices)
}

const isList = (value: Nested): value is Nested[] => Array.isArray(value)
