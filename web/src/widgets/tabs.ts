// Panels behind tabs, by the usual keys: arrows, Home and End.

import type { Options } from '../state/options'
import { page, store } from '../state/store'
import { toggle } from './bound'
import { h } from './dom'

export type Panel = [Options['tab'], string, HTMLElement]

export function tabs(panels: Panel[]): HTMLElement {
  const names = panels.map(([name]) => name)
  const heads = panels.map(([name, title]) =>
    h(
      'button',
      {
        type: 'button',
        role: 'tab',
        id: `tab-${name}`,
        'aria-controls': `panel-${name}`,
        onclick: () => store.set({ tab: name }),
      },
      title,
    ),
  )
  const bodies = panels.map(([name, , body]) =>
    h('div', { role: 'tabpanel', id: `panel-${name}`, 'aria-labelledby': `tab-${name}`, class: 'panel' }, body),
  )
  const list = h('div', { role: 'tablist', 'aria-label': 'Panels', class: 'tabs' }, ...heads)
  const show = () => {
    const at = Math.max(0, names.indexOf(page.tab))
    heads.forEach((head, i) => {
      head.setAttribute('aria-selected', String(i === at))
      head.tabIndex = i === at ? 0 : -1
    })
    bodies.forEach((body, i) => {
      body.hidden = i !== at
    })
  }
  list.addEventListener('keydown', (event) => {
    const at = names.indexOf(page.tab)
    const to = { ArrowRight: at + 1, ArrowLeft: at - 1, Home: 0, End: names.length - 1 }[event.key]
    if (to === undefined) return
    event.preventDefault()
    const next = (to + names.length) % names.length
    store.set({ tab: names[next] })
    heads[next].focus()
  })
  const title = 'Give the panels the whole width'
  const whole = toggle('wide', '⤢ Wide', { class: 'quiet wide-only', title })
  store.on(['wide'], () => document.body.classList.toggle('wide', page.wide))
  list.append(h('span', { class: 'spring' }), whole)
  store.on(['tab'], show)
  show()
  return h('div', { class: 'panels-side' }, list, ...bodies)
}
