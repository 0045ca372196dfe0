// The design: every number as a form, or its file as text. Errors stand at the field and at the line.

import { ask, Refused } from '../state/api'
import { button, freshId, h, select, settled, status } from '../widgets/dom'
import { saveText } from '../widgets/download'
import { field, parsed } from '../widgets/format'
import { change } from './parameters'
import { page, sourceKey, store, type Page } from '../state/store'
import type { Design, Field, FieldError } from '../state/answers'

type Nested = number | Nested[]
export const MOST_TEXT = 1024 * 1024

/** Open a design: shown if it is one, with the rest of a state, otherwise its text with what is wrong. Resolves to whether it was. */
export async function open(text: string, preset: string, rest: Partial<Page> = {}): Promise<boolean> {
  if (text.length > MOST_TEXT) {
    draft(text.slice(0, 2000), [
      { key: '', message: `The file has ${text.length} characters; a design has at most ${MOST_TEXT}.`, line: 0 },
    ])
    return false
  }
  try {
    const design = await ask<Design>('api/design', { design: text, changes: {} })
    store.set({
      text,
      preset,
      changes: {},
      design,
      described: sourceKey(text, {}),
      box: design.box,
      pose: design.home,
      mode: -1,
      error: '',
      ...rest,
    })
    return true
  } catch (error) {
    if (!(error instanceof Refused)) throw error
    draft(text, error.fields.length ? error.fields : [{ key: '', message: error.message, line: 0 }])
    return false
  }
}

let draft: (text: string, errors: FieldError[]) => void = () => undefined

const allEqual = (value: Nested): boolean =>
  Array.isArray(value) && value.every((v) => JSON.stringify(v) === JSON.stringify(value[0]))

class FieldRow {
  readonly element: HTMLElement
  private readonly cells = h('div', { class: 'cells' })
  private readonly wrong = h('p', { class: 'wrong', role: 'alert', hidden: true, id: freshId('wrong') })
  private each = false
  private value: Nested | undefined

  constructor(private readonly rule: Field) {
    const name = rule.key
      .replace(/^\w+\./, '')
      .replace(/_deg$/, '')
      .replace(/[._]/g, ' ')
    const perLeg = rule.key.startsWith('legs.') || rule.shapes.length > 1
    this.element = h(
      'div',
      { class: 'field-row', 'data-key': rule.key },
      h(
        'div',
        { class: 'bar' },
        h('strong', {}, name),
        h('span', { class: 'unit' }, rule.unit),
        h('span', { class: 'meaning' }, rule.meaning),
        h('span', { class: 'spring' }),
        perLeg && button('Each leg', () => this.turn(), { class: 'quiet each', 'aria-pressed': 'false' }),
      ),
      this.cells,
      this.wrong,
    )
  }

  private turn(): void {
    this.each = !this.each
    this.element.querySelector('.each')!.setAttribute('aria-pressed', String(this.each))
    this.draw()
  }

  fail(message: string): void {
    this.wrong.textContent = message
    this.wrong.hidden = !message
    for (const cell of this.cells.querySelectorAll('input')) {
      cell.setAttribute('aria-invalid', String(message !== ''))
      if (message) cell.setAttribute('aria-describedby', this.wrong.id)
    }
  }

  show(value: Nested | undefined): void {
    this.fail('')
    if (JSON.stringify(value) === JSON.stringify(this.value) && this.cells.childElementCount) return
    this.value = value
    if (!this.cells.contains(document.activeElement)) this.draw()
  }

  /** The value in the shape that the cells have: one for all legs where they are alike. */
  private shaped(): Nested {
    const shapes = [...this.rule.shapes].sort((a, b) => a.length - b.length)
    if (this.value === undefined) return blank(shapes[0])
    const full = Array.isArray(this.value) && this.value.length === 6 && shapes.length > 1
    if (full && !this.each && allEqual(this.value)) return (this.value as Nested[])[0]
    if (!full && this.each && shapes.length > 1) return Array.from({ length: 6 }, () => this.value!)
    return this.value
  }

  private draw(): void {
    const shaped = this.shaped()
    let whole = structuredClone(shaped) // what the cells say, finished or not
    const write = (path: number[], text: string) => {
      whole = put(whole, path, text.trim() === '' ? Number.NaN : parsed(text))
      const flat = [whole].flat(3) as number[]
      if (this.rule.optional && flat.every((v) => Number.isNaN(v))) change(this.rule.key, null)
      else if (flat.some((v) => Number.isNaN(v)))
        this.fail(text.trim() === '' ? 'Fill in all the numbers of this field.' : `“${text}” is not a number.`)
      else change(this.rule.key, structuredClone(whole))
    }
    this.cells.replaceChildren(grid(this.rule, shaped, write))
  }
}

function blank(shape: number[]): Nested {
  return shape.length === 0 ? Number.NaN : Array.from({ length: shape[0] }, () => blank(shape.slice(1)))
}

function put(value: Nested, path: number[], item: number): Nested {
  if (!path.length) return item
  const list = value as Nested[]
  list[path[0]] = put(list[path[0]], path.slice(1), item)
  return list
}

/** Inputs for a number, a list or a matrix; a list of matrices one below the other. */
function grid(rule: Field, value: Nested, write: (path: number[], text: string) => void): HTMLElement {
  const cell = (v: number, path: number[]) => {
    const place = path.map((i) => `[${i}]`).join('')
    const input = h('input', {
      type: 'text',
      class: 'number',
      inputmode: 'decimal',
      value: Number.isNaN(v) ? '' : field(Number(v.toPrecision(9))),
      'aria-label': `${rule.key}${place} ${rule.unit}`,
      placeholder: rule.optional ? 'none' : '',
    })
    input.addEventListener('change', () => {
      write(path, input.value)
    })
    return input
  }
  if (!Array.isArray(value)) return h('div', { class: 'line' }, cell(value, []))
  if (!Array.isArray(value[0])) return h('div', { class: 'line' }, ...value.map((v, i) => cell(v as number, [i])))
  if (!Array.isArray((value[0] as Nested[])[0]))
    return h(
      'div',
      { class: 'matrix' },
      ...value.map((row, i) => h('div', { class: 'line' }, ...(row as number[]).map((v, j) => cell(v, [i, j])))),
    )
  return h(
    'div',
    { class: 'matrices' },
    ...value.map((m, k) =>
      h(
        'div',
        { class: 'matrix' },
        h('span', { class: 'hint' }, `leg ${k + 1}`),
        ...(m as number[][]).map((row, i) => h('div', { class: 'line' }, ...row.map((v, j) => cell(v, [k, i, j])))),
      ),
    ),
  )
}

const GROUPS: [string, string][] = [
  ['gravity', 'Gravity'],
  ['base.', 'Base'],
  ['platform.', 'Platform'],
  ['legs.', 'Legs'],
  ['limits.', 'Limits'],
  ['home.', 'Home pose'],
]

function form(fields: Field[]): { element: HTMLElement; fail(key: string, message: string): boolean } {
  const rows = new Map(fields.map((f) => [f.key, new FieldRow(f)]))
  const name = h('input', { type: 'text', id: freshId('name'), 'data-key': 'name' })
  name.addEventListener('change', () => change('name', name.value))
  store.on(['design'], () => {
    for (const [key, row] of rows) row.show(page.design?.values[key] as Nested | undefined)
    if (document.activeElement !== name) name.value = page.design?.name ?? ''
  })
  const groups = GROUPS.map(([start, title]) => {
    const inside = [...rows].filter(([key]) => key === start || (start.endsWith('.') && key.startsWith(start)))
    return h(
      'details',
      { class: 'fold', open: start === 'platform.' || undefined },
      h('summary', {}, title),
      ...inside.map(([, row]) => row.element),
    )
  })
  const element = h(
    'div',
    { class: 'form' },
    h('div', { class: 'bar' }, h('label', { for: name.id }, 'Name'), name),
    ...groups,
  )
  return {
    element,
    fail(key, message) {
      const stem = key.replace(/\[.*$/, '')
      const row = rows.get(stem) ?? rows.get(`${stem}_deg`)
      row?.fail(message)
      const fold = row?.element.closest('details')
      if (fold) fold.open = true
      return row !== undefined
    },
  }
}

interface Editor {
  element: HTMLElement
  show(text: string, errors: FieldError[]): void
  drafting(): boolean
}

function editor(): Editor {
  let drafting = false // the text is no design, and not the one of the machine shown
  const area = h('textarea', {
    class: 'code',
    spellcheck: 'false',
    autocomplete: 'off',
    wrap: 'off',
    'aria-label': 'Design file (TOML)',
    rows: 30,
  })
  const gutter = h('div', { class: 'gutter', 'aria-hidden': 'true' })
  const list = h('ul', { class: 'errors', role: 'alert' })
  const number = (errors: FieldError[]) => {
    const wrong = new Set(errors.map((e) => e.line))
    gutter.replaceChildren(
      ...area.value.split('\n').map((_, i) => h('div', { class: wrong.has(i + 1) ? 'bad' : '' }, String(i + 1))),
    )
    gutter.scrollTop = area.scrollTop
  }
  const goTo = (line: number) => {
    const lines = area.value.split('\n')
    const start = lines.slice(0, line - 1).join('\n').length + (line > 1 ? 1 : 0)
    area.focus()
    area.setSelectionRange(start, start + lines[line - 1].length)
    area.scrollTop = Math.max(0, (line - 6) * 18)
  }
  const complain = (errors: FieldError[]) => {
    const broken = errors.length > 0
    list.replaceChildren(
      ...errors.map((e) =>
        h(
          'li',
          {},
          e.line ? button(`line ${e.line}`, () => goTo(e.line), { class: 'link' }) : null,
          e.line ? ': ' : '',
          e.message,
        ),
      ),
    )
    area.setAttribute('aria-invalid', String(broken))
    number(errors)
  }
  const read = settled(400, async () => {
    const text = area.value
    try {
      const design = await ask<Design>('api/design', { design: text, changes: {} })
      if (text !== area.value) return
      complain([])
      if (text !== page.text || Object.keys(page.changes).length)
        store.set({ text, preset: '', changes: {}, design, described: sourceKey(text, {}), error: '' })
    } catch (error) {
      if (!(error instanceof Refused)) throw error
      if (text === area.value)
        complain(error.fields.length ? error.fields : [{ key: '', message: error.message, line: 0 }])
    }
  })
  area.addEventListener('input', () => {
    number([])
    read()
  })
  area.addEventListener('scroll', () => (gutter.scrollTop = area.scrollTop))
  store.on(['text'], () => (drafting = false))
  store.on(['design'], () => {
    if (drafting || document.activeElement === area || !page.design) return
    area.value = page.design.toml
    complain([])
  })
  return {
    element: h('div', {}, list, h('div', { class: 'editor' }, gutter, area)),
    drafting: () => drafting,
    show(text, errors) {
      drafting = true
      area.value = text
      complain(errors)
    },
  }
}

export interface DesignPanel {
  element: HTMLElement
  fail(key: string, message: string): boolean
}

export function designPanel(fields: Field[], reveal: () => void): DesignPanel {
  const sheet = form(fields)
  const text = editor()
  const note = status({ class: 'hint' })
  const view = select(
    'View of the design',
    [
      ['form', 'Form'],
      ['toml', 'TOML text'],
    ] as const,
    'form',
    (v) => turn(v),
  )
  const turn = (v: 'form' | 'toml') => {
    view.set(v)
    sheet.element.hidden = v !== 'form'
    text.element.hidden = v !== 'toml'
  }
  turn('form')
  draft = (content, errors) => {
    text.show(content, errors)
    turn('toml')
    note.textContent = 'This file is not a design yet; the machine shown is the one before. Correct the marked lines.'
    reveal()
  }
  const warnings = h('ul', { class: 'warnings' })
  store.on(['design'], () => {
    if (!text.drafting()) note.textContent = ''
    warnings.replaceChildren(...(page.design?.warnings ?? []).map((w) => h('li', {}, w)))
  })
  const save = () =>
    page.design && saveText(`${page.design.name.replace(/[^\w.-]+/g, '-')}.toml`, page.design.toml, 'application/toml')
  return {
    element: h(
      'div',
      { id: 'design' },
      h(
        'div',
        { class: 'bar' },
        h('h2', {}, 'Design'),
        view.element,
        h('span', { class: 'spring' }),
        button('Save TOML', save, { class: 'quiet' }),
      ),
      note,
      warnings,
      sheet.element,
      text.element,
    ),
    fail: sheet.fail,
  }
}
