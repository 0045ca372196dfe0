// The machine in 3-D with the colour bar of its legs, and what is to be said of the pose.

import type { Theme } from '../charts/look'
import type { Scene } from '../machine3d/scene'
import type { Snapshot } from '../state/answers'
import { h } from '../widgets/dom'
import { type Chosen, colourBar, legColours } from './leg-colours'

export const VIEWS = { iso: 'Iso', front: 'Front', side: 'Side', top: 'Top' } as const

const PLAIN = { light: '#6b7f94', dark: '#8fa3b8' }

export class Stage {
  readonly element: HTMLElement
  readonly notes = h('ul', { class: 'notes', 'aria-label': 'Notes on this pose' })
  private readonly legend = colourBar()

  constructor(
    private readonly scene: Scene,
    private readonly theme: () => Theme,
  ) {
    this.element = h('div', { class: 'stage' }, scene.element, this.legend.element)
  }

  /** `leg`: mean length of a leg at home, m. */
  show(s: Snapshot, leg: number, chosen: Chosen): void {
    const { machine } = this.scene
    if (machine.show(s.geometry, leg)) this.scene.paintGround()
    const { dark } = this.theme()
    const painted = legColours(s, chosen, dark)
    this.legend.show(painted, chosen)
    const exceeded = s.limits.by_leg.map((words) => words.length > 0)
    machine.paint(painted?.colours ?? Array(6).fill(dark ? PLAIN.dark : PLAIN.light), exceeded)
    this.notes.replaceChildren(
      ...s.grave.map((words) => h('li', { class: 'grave' }, words)),
      ...s.limits.exceeded.map((words) => h('li', { class: 'exceeded' }, `▲ ${words}`)),
      ...s.warnings.map((words) => h('li', {}, words)),
    )
    this.scene.draw()
  }
}
