// Which stiffness the legs have: a constant one, or a law by their length.

import { page, sourceKey, store } from '../state/store'
import { h, select } from '../widgets/dom'

const KIND = 'legs.stiffness_law.kind'
const CONSTANT = 'constant'
const KINDS = [
  [CONSTANT, 'Constant'],
  ['screw', 'Screw: softer the longer'],
  ['hydraulic', 'Columns of oil: stiffer at both ends'],
  ['table', 'Table of lengths'],
] as const

/** The kind of the design shown. */
export function lawKind(): string {
  return (page.design?.values[KIND] as string | undefined) ?? CONSTANT
}

/** Chosen while the design that the laws belong to has not come yet. */
let chosen = ''

/** Give the legs another law, with which they are as stiff at home as before. */
function take(kind: string): void {
  chosen = page.described === sourceKey(page.text, page.changes) ? '' : kind
  if (chosen) return
  const law = page.design?.laws[kind]
  if (!law) return
  const kept = Object.entries(page.changes).filter(([key]) => !key.startsWith('legs.stiffness'))
  store.set({ changes: { ...Object.fromEntries(kept), ...law } })
}

export function legLaw(): HTMLElement {
  const { element } = select<string>('Stiffness of the legs', KINDS, CONSTANT, take)
  store.on(['design'], () => {
    if (chosen) take(chosen)
    element.value = lawKind()
    for (const option of element.options) option.disabled = !page.design?.laws[option.value]
  })
  const meaning = h('span', { class: 'meaning' }, 'a law starts as stiff at home as the legs are')
  return h(
    'div',
    { class: 'field-row', 'data-key': KIND },
    h('div', { class: 'bar' }, h('strong', {}, 'stiffness of the legs'), element, meaning),
  )
}
