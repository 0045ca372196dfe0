// The 3-D view with its tools: standard views, what colours the legs, the colour bar, and warnings.

import { onTheme, css, cividis, signed, theme } from '../charts/colours'
import { button, h, select } from '../widgets/dom'
import { sig } from '../widgets/format'
import type { Scene } from '../machine3d/scene'
import { page, store, type Page } from '../state/store'
import type { Snapshot } from '../state/answers'

interface Painted {
  colours: string[]
  label: string
  low: number
  high: number
  map: (t: number) => [number, number, number]
}

/** Colours of the legs by the chosen quantity; grey where it does not exist. */
function painted(s: Snapshot): Painted | null {
  const by: Page['colour'] = page.colour
  const values =
    by === 'force'
      ? s.legs.force
      : by === 'energy'
        ? s.legs.energy
        : by === 'strain'
          ? (s.strain[page.mode] ?? null)
          : null
  if (!values || values.some((v) => v === null)) return null
  const numbers = values as number[]
  const most = Math.max(...numbers.map(Math.abs)) || 1
  const both = by === 'force' && Math.min(...numbers) < 0
  const [low, high] = both ? [-most, most] : [0, most]
  const sequential = theme().dark ? (t: number) => cividis(0.22 + 0.78 * t) : cividis // its darkest would sink into the ground
  const map = both ? signed : sequential
  const label =
    by === 'force'
      ? 'static force, N (+ compression)'
      : by === 'energy'
        ? 'static strain energy, J'
        : `strain energy share, mode ${page.mode + 1}`
  return { colours: numbers.map((v) => css(map((v - low) / (high - low)))), label, low, high, map }
}

function colourBar(): { element: HTMLElement; show(p: Painted | null): void } {
  const strip = h('canvas', { width: 128, height: 1, 'aria-hidden': 'true' })
  const [low, high, label] = [h('span'), h('span'), h('span', { class: 'label' })]
  const element = h('div', { class: 'legend' }, label, h('div', { class: 'strip' }, low, strip, high))
  return {
    element,
    show(p) {
      element.hidden = !p
      if (!p) return
      const context = strip.getContext('2d')!
      for (let i = 0; i < 128; i++) {
        context.fillStyle = css(p.map(i / 127))
        context.fillRect(i, 0, 1, 1)
      }
      low.textContent = sig(p.low, 3)
      high.textContent = sig(p.high, 3)
      label.textContent = p.label
    },
  }
}

const NAMES = { iso: 'Iso', front: 'Front', side: 'Side', top: 'Top' }

export function viewPanel(scene: Scene): HTMLElement {
  const legend = colourBar()
  const colour = select(
    'Colour of the legs',
    [
      ['force', 'Legs: force'],
      ['energy', 'Legs: energy'],
      ['strain', 'Legs: strain in mode'],
      ['plain', 'Legs: plain'],
    ] as const,
    page.colour,
    (value) => store.set({ colour: value }),
  )
  const labels = button(
    'Labels',
    () => {
      scene.machine.showLabels(!scene.machine.labelsShown)
      labels.setAttribute('aria-pressed', String(scene.machine.labelsShown))
      scene.draw()
    },
    { 'aria-pressed': 'true', class: 'quiet' },
  )
  const notes = h('ul', { class: 'notes', 'aria-label': 'Notes on this pose' })
  let digest = ''
  const show = () => {
    const s = page.snapshot
    if (!s || !page.design) return
    const rebuilt = scene.machine.show(s.geometry, page.design.leg)
    if (rebuilt) scene.paintGround()
    const shape = `${page.text}`
    if (shape !== digest) scene.look('iso')
    digest = shape
    const p = painted(s)
    legend.show(p)
    const plain = theme().dark ? '#8fa3b8' : '#6b7f94'
    scene.machine.paint(
      p?.colours ?? Array(6).fill(plain),
      s.limits.by_leg.map((words) => words.length > 0),
    )
    notes.replaceChildren(
      ...s.limits.exceeded.map((words) => h('li', { class: 'exceeded' }, `▲ ${words}`)),
      ...s.warnings.map((words) => h('li', {}, words)),
    )
    scene.draw()
  }
  store.on(['snapshot', 'colour'], show)
  store.on(['mode'], () => {
    if (page.colour === 'strain') show()
  })
  store.on(['colour'], () => colour.set(page.colour))
  onTheme(show)
  const file = () => (page.design?.name ?? 'hexapod').replace(/[^\w.-]+/g, '-')
  const views = (['iso', 'front', 'side', 'top'] as const).map((name) =>
    button(NAMES[name], () => scene.look(name), { class: 'quiet', title: `${name} view` }),
  )
  return h(
    'section',
    { class: 'view', 'aria-label': 'The machine in 3-D' },
    h(
      'div',
      { class: 'bar tools over' },
      h('span', { role: 'group', 'aria-label': 'Standard views' }, ...views),
      colour.element,
      labels,
      h('span', { class: 'spring' }),
      button('PNG', () => scene.savePng(file()), { class: 'quiet', 'aria-label': '3-D view as PNG' }),
      button('SVG', () => void scene.saveSvg(file()), { class: 'quiet', 'aria-label': '3-D view as SVG' }),
    ),
    h('div', { class: 'stage' }, scene.element, legend.element),
    notes,
  )
}
