// The pose box: ranges of the six coordinates, as a table to fill in.

import { COORDINATES } from '../state/answers'
import { page, store } from '../state/store'
import { button, h } from '../widgets/dom'
import { field, parsed } from '../widgets/format'

const SIDES = ['low', 'high'] as const

/** The unit in which the server has a coordinate. */
export const unitOf = (i: number): string => (i < 3 ? 'm' : '°')

function input(i: number, side: 'low' | 'high', show: () => void): HTMLInputElement {
  const label = `${side === 'low' ? 'Least' : 'Greatest'} ${COORDINATES[i]}, ${unitOf(i)}`
  const element = h('input', { type: 'text', class: 'number', inputmode: 'decimal', 'aria-label': label })
  element.addEventListener('change', () => {
    const value = parsed(element.value)
    if (!Number.isFinite(value)) return show()
    const box = { low: [...page.box.low], high: [...page.box.high] }
    box[side][i] = value
    store.set({ box })
  })
  return element
}

export function boxTable(): HTMLElement {
  const show = () =>
    inputs.forEach((pair, i) => {
      const wrong = page.box.low[i] > page.box.high[i]
      pair.forEach((element, k) => {
        element.value = field(page.box[SIDES[k]][i] ?? 0)
        element.setAttribute('aria-invalid', String(wrong))
      })
    })
  const inputs = COORDINATES.map((_, i) => SIDES.map((side) => input(i, side, show)))
  store.on(['box'], show)
  const head = h('tr', {}, ...['', 'from', 'to'].map((text) => h('th', { scope: 'col' }, text)))
  const rows = COORDINATES.map((c, i) => {
    return h('tr', {}, h('th', { scope: 'row' }, `${c}, ${unitOf(i)}`), ...inputs[i].map((e) => h('td', {}, e)))
  })
  const table = h('table', { class: 'data narrow' }, h('thead', {}, head), h('tbody', {}, ...rows))
  const reset = () => page.design && store.set({ box: page.design.box })
  const own = button('Box of the design', reset, { class: 'quiet' })
  return h('details', { class: 'fold', 'data-part': 'box' }, h('summary', {}, 'Pose box'), table, own)
}
