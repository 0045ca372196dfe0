// The 3-D view of the page with its tools: standard views, what colours the legs, pictures.

import { onTheme, theme } from '../charts/theme'
import type { Scene } from '../machine3d/scene'
import { COLOURS } from '../snapshot/leg-colours'
import { Stage, VIEWS } from '../snapshot/stage'
import { page, store } from '../state/store'
import { choose, toggle } from '../widgets/bound'
import { button, h } from '../widgets/dom'
import { fileName } from '../widgets/format'
import { spring } from '../widgets/layout'

export function viewPanel(scene: Scene): HTMLElement {
  const stage = new Stage(scene, theme)
  let shown = '' // text of the design that is drawn
  const show = () => {
    const s = page.snapshot
    if (!s || !page.design) return
    stage.show(s, page.design.leg, page)
    if (page.text !== shown) scene.look(page.view)
    shown = page.text
  }
  store.on(['snapshot', 'colour'], show)
  store.on(['mode'], () => {
    if (page.colour === 'strain') show()
  })
  onTheme(show)
  return h('section', { class: 'view', 'aria-label': 'The machine in 3-D' }, tools(scene), stage.element, stage.notes)
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
