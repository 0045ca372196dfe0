// The main results at a pose, spoken when they settle.

import type { Snapshot } from '../state/answers'
import { h, settled, status } from '../widgets/dom'
import { sig } from '../widgets/format'

interface Result {
  name: string
  id: string
  unit: string
  text(s: Snapshot): string
}

const RESULTS: Result[] = [
  { name: 'At rest', id: 'stability', unit: '', text: (s) => s.stability },
  { name: 'Index ω₁', id: 'index', unit: 'rad/s', text: (s) => sig(s.index) },
  { name: 'f₁', id: 'frequency', unit: 'Hz', text: (s) => sig(s.frequency[0]) },
  { name: 'cond(H)', id: 'condition', unit: '', text: (s) => sig(s.condition, 4) },
  { name: 'Max force', id: 'force', unit: 'N', text: largestForce },
  { name: 'Limits', id: 'limits', unit: '', text: limits },
]

function largestForce({ legs }: Snapshot): string {
  return legs.force ? sig(Math.max(...legs.force.map((f) => Math.abs(f ?? 0))), 4) : '–'
}

function limits({ limits: { any, ok, exceeded } }: Snapshot): string {
  if (!any) return 'none set'
  return ok ? 'within' : `${exceeded.length} exceeded`
}

/** Says the main numbers; and the state at rest and how many limits are exceeded, if these have changed. */
function speaker(): (s: Snapshot) => string {
  let before: string[] = []
  return (s) => {
    const numbers = `Index ${sig(s.index, 4)} radians per second, condition number ${sig(s.condition, 3)}.`
    const states = [`At rest: ${s.stability}.`, s.limits.any ? `Limits: ${limits(s)}.` : '']
    const news = states.filter((words, i) => words !== before[i])
    before = states
    return [...news, numbers].filter(Boolean).join(' ')
  }
}

export function readout(): { element: HTMLElement; show(s: Snapshot): void } {
  const cells = RESULTS.map(({ name, id, unit, text }) => {
    const value = h('output', { id })
    const title = h('span', { class: 'name' }, name, unit && `, ${unit}`)
    return { id, text, value, element: h('div', { class: 'figure' }, title, value) }
  })
  const spoken = status({ class: 'hidden' })
  const words = speaker()
  let shown: Snapshot | null = null
  const speak = settled(900, () => {
    if (shown) spoken.textContent = words(shown)
  })
  const show = (s: Snapshot) => {
    shown = s
    for (const { id, text, value, element } of cells) {
      value.textContent = text(s)
      element.classList.toggle('exceeded', id === 'limits' && !s.limits.ok)
      element.classList.toggle('grave', id === 'stability' && s.stability !== 'stable')
    }
    speak()
  }
  const elements = cells.map((cell) => cell.element)
  const element = h('div', { class: 'readout', role: 'group', 'aria-label': 'Main results' }, ...elements, spoken)
  return { element, show }
}
