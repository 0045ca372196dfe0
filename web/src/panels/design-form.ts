// The design as a form: every number at its field, in groups.

import type { Field } from '../state/answers'
import { page, store } from '../state/store'
import { freshId, h } from '../widgets/dom'
import { FieldRow } from './field-row'
import { lawKind, legLaw } from './leg-law'
import type { Nested } from './nested'
import { change } from './parameters'

const GROUPS: [string, string][] = [
  ['gravity', 'Gravity'],
  ['base.', 'Base'],
  ['platform.', 'Platform'],
  ['legs.', 'Legs'],
  ['suspension.', 'Suspension'],
  ['limits.', 'Limits'],
  ['drive.', 'Drive'],
  ['home.', 'Home pose'],
]

export class DesignForm {
  readonly element: HTMLElement
  private readonly rows: Map<string, FieldRow>

  constructor(fields: Field[]) {
    this.rows = new Map(fields.map((field) => [field.key, new FieldRow(field)]))
    const name = h('input', { type: 'text', id: freshId('name'), 'data-key': 'name' })
    name.addEventListener('change', () => change('name', name.value))
    store.on(['design'], () => {
      const law = lawKind()
      for (const [key, row] of this.rows) row.show(page.design?.values[key] as Nested | undefined, law)
      if (document.activeElement !== name) name.value = page.design?.name ?? ''
    })
    const naming = h('div', { class: 'bar' }, h('label', { for: name.id }, 'Name'), name)
    this.element = h(
      'div',
      { class: 'form', 'data-part': 'changes' },
      naming,
      ...GROUPS.map(([start, title]) => this.group(start, title)),
    )
  }

  private group(start: string, title: string): HTMLElement {
    const inside = [...this.rows].filter(([key]) => key === start || (start.endsWith('.') && key.startsWith(start)))
    const elements = inside.map(([, row]) => row.element)
    if (start === 'legs.') elements.unshift(legLaw())
    return h('details', { class: 'fold', open: start === 'platform.' }, h('summary', {}, title), ...elements)
  }

  /** Show an error at the field of a key. */
  fail(key: string, message: string): void {
    const stem = key.replace(/\[.*$/, '')
    const row = this.rows.get(stem) ?? this.rows.get(`${stem}_deg`)
    if (!row) return
    row.fail(message)
    const fold = row.element.closest('details')
    if (fold) fold.open = true
  }
}
