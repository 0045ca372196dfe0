// The 3-D view with its tools: standard views, what colours the legs, the colour bar, and warnings.

import { onTheme, theme } from '../charts/theme'
import type { Scene } from '../machine3d/scene'
import { page, store } from '../state/store'
import { choose, toggle } from '../widgets/bound'
import { button, h } from '../widgets/dom'
import { fileName } from '../widgets/format'
import { spring } from '../widgets/layout'
import { colourBar, legColours } from './leg-colours'

const VIEWS = { iso: 'Iso', front: 'Front', side: 'Side', top: 'Top' } as const
const COLOURS = [
  ['force', 'Legs: force'],
  ['energy', 'Legs: energy'],
  ['strain', 'Legs: strain in mode'],
  ['plain', 'Legs: plain'],
] as const

export function viewPanel(scene: Scene): HTMLElement {
  const legend = colourBar()
  const notes = h('ul', { class: 'notes', 'aria-label': 'Notes on this pose' })
  let shown = '' // text of the design that is drawn
  const show = () => {
    const s = page.snapshot
    if (!s || !page.design) return
    if (scene.machine.show(s.geometry, page.design.leg)) scene.paintGround()
    if (page.text !== shown) scene.look(page.view)
    shown = page.text
    const painted = legColours(s)
    legend.show(painted)
    const plain = theme().dark ? '#8fa3b8' : '#6b7f94'
    const exceeded = s.limits.by_leg.map((words) => words.length > 0)
    scene.machine.paint(painted?.colours ?? Array(6).fill(plain), exceeded)
    notes.replaceChildren(
      ...s.grave.map((words) => h('li', { class: 'grave' }, words)),
      ...s.limits.exceeded.map((words) => h('li', { class: 'exceeded' }, `▲ ${words}`)),
      ...s.warnings.map((words) => h('li', {}, words)),
    )
    scene.draw()
  }
  store.on(['snapshot', 'colour'], show)
  store.on(['mode'], () => {
    if (page.colour === 'strain') show()
  })
  onTheme(show)
  const stage = h('div', { class: 'stage' }, scene.element, legend.element)
  return h('section', { class: 'view', 'aria-label': 'The machine in 3-D' }, tools(scene), stage, notes)
}

function tools(scene: Scene): HTMLElement {
  const views = (Object.keys(VIEWS) as (keyof typeof VIEWS)[]).map((name) =>
    button(VIEWS[name], () => store.set({ view: name }), { class: 'quiet', title: `${name} view` }),
  )
  store.on(['view'], () => scene.look(page.view))
  scene.turned = (view) => store.set({ view })
  store.on(['labels'], () => {
    scene.machine.showLabels(page.labels)
    scene.draw()
  })
  const file = () => fileName(page.design?.name ?? 'hexapod')
  return h(
    'div',
    { class: 'bar tools over' },
    h('span', { role: 'group', 'aria-label': 'Standard views' }, ...views),
    choose('colour', 'Colour of the legs', COLOURS),
    toggle('labels', 'Labels', { class: 'quiet' }),
    spring(),
    button('PNG', () => scene.savePng(file()), { class: 'quiet', 'aria-label': '3-D view as PNG' }),
    button('SVG', () => void scene.saveSvg(file()), { class: 'quiet', 'aria-label': '3-D view as SVG' }),
  )
}
